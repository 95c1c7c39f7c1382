// Provides: the picture's radiance at a quarter of its width. Every other pixel, as on a chessboard:
// glints are wider than that.

uniform sampler2D u_radiance;
uniform int u_views;
uniform int u_px;      // picture pixels per texel

out vec4 o_radiance;

void main() {
    ivec2 size = textureSize(u_radiance, 0), texel = ivec2(gl_FragCoord.xy);
    int wide = size.x / u_views, columns = (wide + u_px - 1) / u_px;
    ivec2 first = ivec2((texel.x / columns) * wide + (texel.x % columns) * u_px, texel.y * u_px);
    ivec2 last = ivec2((texel.x / columns + 1) * wide, size.y) - 1;
    vec3 sum = vec3(0.0);
    for (int j = 0; j < u_px; ++j)
        for (int i = j & 1; i < u_px; i += 2)
            sum += texelFetch(u_radiance, min(first + ivec2(i, j), last), 0).rgb;
    o_radiance = vec4(2.0 * sum / float(u_px * u_px), 1.0);
}
