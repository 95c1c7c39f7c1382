// Provides: pixels with an edge as the mean of their four samples. A sample takes its colour from the
// pixel that fits it best, this one or a neighbour (Chajdas et al. 2011, "Subpixel reconstruction
// antialiasing"). PLAIN: 1 for the mean of radiance, 0 for one that suits the tone curve.

#include "edges.glsl"

uniform sampler2D u_radiance;        // one sample per pixel; its alpha is one more than its mark
uniform sampler2D u_depth;           // of those samples
uniform ivec4 u_view;                // x, y, width, height: neighbours lie within
uniform float u_exposure;

out vec4 o_radiance;

const float OTHER_PX = 1e4;          // what another mark counts, in pixels of depth
const float NEIGHBOUR_PX = 0.25;     // the pixel itself comes first
// Where the samples lie: of two neighbours that fit alike the nearer one is taken.
const vec4 RIGHT_PX = vec4(-0.125, 0.375, -0.375, 0.125), UP_PX = vec4(-0.375, -0.125, 0.125, 0.375);

// Karis 2013, "Tone mapping": samples averaged with weights that fall as they get brighter, as if
// after the curve, so that one curve per pixel keeps edges against the sun smooth.
vec4 weighted(vec3 u) {
    float brightest = u_exposure * max(u.r, max(u.g, u.b));
    return PLAIN == 1 ? vec4(u, 1.0) : vec4(u, 1.0) / (1.0 + brightest);
}

struct Pixel {
    vec3 radiance;
    vec4 misfit;    // of each sample, in pixels of depth
};

Pixel pixel_at(ivec2 at, Samples s, vec4 further) {
    at = clamp(at, u_view.xy, u_view.xy + u_view.zw - 1);
    vec4 colour = texelFetch(u_radiance, at, 0);
    vec4 gap = abs(s.depth - texelFetch(u_depth, at, 0).r) / s.step;
    vec4 other = step(0.5, abs(s.mark + 1.0 - colour.a));
    return Pixel(colour.rgb, min(gap, 1e3) + OTHER_PX * other + further);
}

vec4 taken(Pixel p, vec4 best, inout vec4 open) {
    vec4 fits = open * vec4(lessThanEqual(p.misfit, best));
    open -= fits;
    return dot(fits, vec4(1.0)) * weighted(p.radiance);
}

vec4 edge_sum(ivec2 at, Samples s) {
    Pixel own = pixel_at(at, s, vec4(0.0));
    Pixel right = pixel_at(at + ivec2(1, 0), s, NEIGHBOUR_PX * (1.5 - RIGHT_PX));
    Pixel left = pixel_at(at - ivec2(1, 0), s, NEIGHBOUR_PX * (1.5 + RIGHT_PX));
    Pixel above = pixel_at(at + ivec2(0, 1), s, NEIGHBOUR_PX * (1.5 - UP_PX));
    Pixel below = pixel_at(at - ivec2(0, 1), s, NEIGHBOUR_PX * (1.5 + UP_PX));
    vec4 best = min(own.misfit, min(min(right.misfit, left.misfit), min(above.misfit, below.misfit)));
    vec4 open = vec4(1.0), sum = taken(own, best, open);
    sum += taken(right, best, open);
    sum += taken(left, best, open);
    sum += taken(above, best, open);
    return sum + taken(below, best, open);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 sum = edge_sum(at, samples_of(at));
    o_radiance = vec4(sum.rgb / sum.a, 1.0);
}
