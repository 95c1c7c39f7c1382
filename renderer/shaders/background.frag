// Provides: the surroundings out of focus, looked up in a panorama that is already blurred.
// B-spline filtering (16 texels through 4 bilinear lookups): no texel of the panorama shows.

uniform sampler2D u_panorama;   // azimuth -180..180, elevation -90..90 degrees
uniform sampler2D u_farther_panorama;   // blurred for cameras farther off
uniform float u_farther_share;

in vec3 v_direction;
out vec4 o_radiance;

// Ruijters et al. 2008, "Efficient GPU-based texture interpolation using uniform B-splines".
vec3 spline_lookup(sampler2D panorama, vec2 uv) {
    vec2 size = vec2(textureSize(panorama, 0));
    vec2 at = uv * size - 0.5;
    vec2 f = fract(at), g = 1.0 - f;
    at -= f;
    vec2 w0 = g * g * g / 6.0, w1 = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
    vec2 w3 = f * f * f / 6.0, w2 = 1.0 - w0 - w1 - w3;
    vec2 low = w0 + w1, high = w2 + w3;
    vec2 a = (at - 0.5 + w1 / low) / size, b = (at + 1.5 + w3 / high) / size;
    return low.y * (low.x * textureLod(panorama, a, 0.0).rgb
                    + high.x * textureLod(panorama, vec2(b.x, a.y), 0.0).rgb)
         + high.y * (low.x * textureLod(panorama, vec2(a.x, b.y), 0.0).rgb
                     + high.x * textureLod(panorama, b, 0.0).rgb);
}

void main() {
    const float pi = 3.14159265359;
    vec3 d = normalize(v_direction);
    vec2 uv = vec2(atan(d.x, d.z) / (2.0 * pi) + 0.5, asin(clamp(d.y, -1.0, 1.0)) / pi + 0.5);
    vec3 radiance = spline_lookup(u_panorama, uv);
    if (u_farther_share > 0.0)
        radiance = mix(radiance, spline_lookup(u_farther_panorama, uv), u_farther_share);
    o_radiance = vec4(radiance, 1.0);
}
