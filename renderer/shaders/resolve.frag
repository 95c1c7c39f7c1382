// Provides: the last pass. Scene-referred linear radiance (4 samples per pixel) becomes sRGB in
// 8 bits: exposure, one fixed tone curve per sample, average, dither. The first row is the top one.

uniform sampler2DMS u_radiance;
uniform float u_exposure;
uniform int u_height;

out vec4 o_colour;

// Narkowicz 2016, "ACES filmic tone mapping curve": a toe for photographic contrast, a shoulder for
// catch-lights. Per channel, so that strong light desaturates as film does.
vec3 tone_curve(vec3 u) {
    return clamp((u * (2.51 * u + 0.03)) / (u * (2.43 * u + 0.59) + 0.14), 0.0, 1.0);
}

// IEC 61966-2-1.
vec3 encode_srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
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
    ivec2 at = ivec2(p.x, u_height - 1 - p.y);
    vec3 sum = vec3(0.0);
    for (int s = 0; s < 4; ++s) sum += tone_curve(texelFetch(u_radiance, at, s).rgb * u_exposure);
    o_colour = vec4(encode_srgb(sum * 0.25) + dither(p) / 255.0, 1.0);
}
