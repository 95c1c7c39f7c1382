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
// his has 0.21: a fiftieth of the sky, all that a cornea mirrors, stays to be seen. That is
// c = u (2.51 u + 0.1163) / (u (2.4458 u + 0.6162) + 0.1938), white from WHITE on, encoded as sRGB
// (IEC 61966-2-1). Both together are one quotient here, within 0.025 of an 8-bit step (minimax;
// tests/renderer/frame/test_picture.py): on software GL the powers cost half the pass.
const float WHITE = 8.1567;
vec3 shown(vec3 u) {
    u = clamp(u, 0.0, WHITE);
    vec3 above = u * (7.9089031 + u * (-1222.8156 + u * (273472.31 + u * (5804934.0 + u * 23296864.0))));
    return above / (1.0 + u * (-144.30556 + u * (25880.92 + u * (1452054.6 + u * (7773736.0 + u * 23040052.0)))));
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
    o_colour = vec4(shown(mix(own, bloom, u_bloom_share)) + dither(p) / 255.0, 1.0);
}
