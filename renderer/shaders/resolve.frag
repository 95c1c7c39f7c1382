// Provides: the last pass. Scene-referred linear radiance becomes sRGB in 8 bits: bloom, exposure,
// one fixed tone curve, dither. The first row is the top one.

uniform sampler2D u_radiance;
uniform sampler2D u_bloom;     // the same radiance, blurred
uniform float u_bloom_share;
uniform float u_exposure;

out vec4 o_colour;

// A toe for photographic contrast, a shoulder for catch-lights. Per channel, so that strong light
// desaturates as film does. The form of Narkowicz 2016, "ACES filmic tone mapping curve", fitted to
// his curve within 1.2 of 255 steps above u = 0.12, but rising from black with a slope of 0.6 where
// his has 0.21: a fiftieth of the sky, all that a cornea mirrors, stays to be seen.
vec3 tone_curve(vec3 u) {
    return clamp((u * (2.51 * u + 0.1163)) / (u * (2.4458 * u + 0.6162) + 0.1938), 0.0, 1.0);
}

// IEC 61966-2-1 with its power of 1 / 2.4 fitted by three square roots (minimax, within 0.012 of an
// 8-bit step; tests/renderer/frame/test_picture.py): on software GL the power costs half the pass.
const vec4 FIT = vec4(0.64236709, 0.71210854, -0.3368691, -0.01756334);

vec3 encode_srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    vec3 r2 = sqrt(c), r4 = sqrt(r2), r8 = sqrt(r4);
    vec3 curve = FIT.x * r2 + FIT.y * r4 + FIT.z * r8 + FIT.w * c;
    return mix(12.92 * c, curve, step(0.0031308, c));
}

// Bayer's 8 x 8 order, static: the same frame is the same bytes.
float dither(ivec2 p) {
    int x = p.x ^ p.y, y = p.y, m = 0;
    for (int bit = 0; bit < 3; ++bit) m |= (((x >> bit) & 1) << (5 - 2 * bit))
                                         | (((y >> bit) & 1) << (4 - 2 * bit));
    return (float(m) + 0.5) / 64.0 - 0.5;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ivec2 size = textureSize(u_radiance, 0);
    ivec2 at = ivec2(p.x, size.y - 1 - p.y);
    vec3 own = texelFetch(u_radiance, at, 0).rgb * u_exposure;
    vec3 bloom = textureLod(u_bloom, (vec2(at) + 0.5) / vec2(size), 0.0).rgb * u_exposure;
    vec3 shown = tone_curve(mix(own, bloom, u_bloom_share));
    o_colour = vec4(encode_srgb(shown) + dither(p) / 255.0, 1.0);
}
