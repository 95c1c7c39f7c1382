// Provides: the next level of the bloom's pyramid, half as wide, under a tent two
// texels to either side: its weights sum to the same wherever the levels do not divide evenly.

#include "bloom.glsl"

uniform sampler2D u_picture;

out vec4 o_radiance;

void main() {
    vec2 size = vec2(textureSize(u_picture, 0));
    float views = float(u_views), columns = ceil(size.x / views / 2.0);
    vec2 uv = gl_FragCoord.xy / vec2(columns * views, ceil(size.y / 2.0));
    vec3 sum = vec3(0.0);
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            vec2 at = within_view(uv + vec2(i, j) / size, uv.x, u_picture);
            sum += float((2 - abs(i)) * (2 - abs(j))) * textureLod(u_picture, at, 0.0).rgb;
        }
    o_radiance = vec4(sum / 16.0, 1.0);
}
