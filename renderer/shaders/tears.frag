// Provides: the tear line: what its hollow face mirrors of sun and sky, and the dark thread at its
// upper edge where the water bends the view aside. Premultiplied: the rest shines through.

#include "light.glsl"
#include "specular.glsl"

in vec3 v_world;
in vec3 v_normal;
in vec3 v_tangent;
in vec3 v_water;

uniform vec3 u_camera_mm;
uniform float u_mm_per_px;    // size of a pixel at the eye
uniform float u_share;        // of an eye that has a tear line, where it blends into one without

out vec4 out_radiance;

const float TEAR_F0 = 0.021;
const float RADIUS_MM = 0.28;        // of the hollow: the normal turns by a radian over this way
const float HEIGHT_MM = 0.35;        // of the strip, from globe to lid
const float EDGE_SHADE = 0.10;       // what the upper edge takes away
// Share of the strip over which it begins. On the globe the hollow has the film's own slope: what it
// mirrors there, the film has mirrored.
const float BEGIN = 0.4;
// The hollow spreads sunlight that falls through it; what it loses gathers in a line along its foot
// on the lid: how much brighter the moist lid is there.
const float GATHERED = 0.42;
const vec3 MUCOSA = vec3(0.70, 0.53, 0.48);
// Slopes of the water, root mean square. Across, the hollow is smooth; along the lid lashes, oil
// and mucus ripple it, which draws the sun's image out into a line: a sharp and a wide part.
const float ACROSS = 0.05;
const vec2 ALONG = vec2(0.05, 0.40);
const vec2 SHARE = vec2(0.5, 0.5);
// The harmonics keep a ninth of a real sky's contrast: bright clouds and the sun's halo count more.
const float SKY_CONTRAST = 3.0;

// Beckmann's distribution with two slopes (Ward 1992), for small angles.
float lobe(vec3 n, vec3 h, vec2 slopes) {
    vec3 t = normalize(v_tangent - n * dot(n, v_tangent));
    vec2 x = vec2(dot(h, t), dot(h, cross(n, t))) / slopes;
    return exp(-0.5 * dot(x, x)) / (2.0 * PI * slopes.x * slopes.y);
}

vec3 sun_mirrored(vec3 n, vec3 v, float visible) {
    vec3 h = normalize(v + u_sun_direction);
    float across = length(vec2(ACROSS, min(0.4 * u_mm_per_px / RADIUS_MM, 0.5)));
    float d = SHARE.x * lobe(n, h, vec2(ALONG.x, across)) + SHARE.y * lobe(n, h, vec2(ALONG.y, across));
    float l_dot_h = max(dot(u_sun_direction, h), 0.1);
    float lit = max(dot(n, u_sun_direction), 0.0) * visible;
    return u_sun_irradiance * (schlick(l_dot_h, TEAR_F0) * d * lit / (4.0 * l_dot_h * l_dot_h));
}

vec3 sun_gathered(vec3 n, float visible) {
    float foot = (v_water.x - 0.80) / 0.13;
    float lit = max(dot(n, u_sun_direction), 0.0) * visible;
    return u_sun_irradiance / PI * MUCOSA * (GATHERED * v_water.z * lit * exp(-foot * foot));
}

vec3 sky_mirrored(vec3 n, vec3 v, float fresnel) {
    vec3 r = reflect(-v, n);
    // Below the horizon lashes, cheek and ground are darker; behind stands the head.
    float open_share = smoothstep(-0.35, 0.35, r.y) * smoothstep(-0.3, 0.2, r.z);
    return fresnel * mix(0.25, SKY_CONTRAST, open_share) * ambient_irradiance(r) / PI;
}

void main() {
    vec3 v = normalize(u_camera_mm - v_world);
    vec3 n = normalize(v_normal);
    // Where the globe turns away the strip would mirror lids and nose, which the harmonics do not know.
    float fresnel = schlick(clamp(dot(n, v), 0.25, 1.0), TEAR_F0);
    float edge = 1.0 - smoothstep(0.0, 0.35, v_water.x);
    fresnel *= smoothstep(0.0, BEGIN, v_water.x);
    float taken = fresnel + EDGE_SHADE * edge * (1.0 - edge) * 4.0;
    // A line narrower than a pixel fills but a part of it.
    float amount = v_water.y * min(HEIGHT_MM / u_mm_per_px, 1.0);
    float visible = sun_visibility(v_world, 1.5);
    vec3 radiance = sky_mirrored(n, v, fresnel) + sun_mirrored(n, v, visible) + sun_gathered(n, visible);
    out_radiance = u_share * amount * vec4(radiance, taken);
}
