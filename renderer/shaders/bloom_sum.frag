// Provides: a level of the bloom's pyramid, blurred and weighted, on top of the sum of wider ones,
// which is blurred already.

#include "bloom.glsl"

uniform sampler2D u_picture;
uniform sampler2D u_wider;
uniform float u_weight;

out vec4 o_radiance;

vec3 blurred(sampler2D picture, vec2 uv) {
    vec2 texel = 1.0 / vec2(textureSize(picture, 0));
    vec3 sum = vec3(0.0);
    for (int j = -1; j <= 1; j += 2)
        for (int i = -1; i <= 1; i += 2) {
            vec2 at = uv + 0.75 * vec2(i, j) * texel;
            sum += textureLod(picture, within_view(at, uv.x, picture), 0.0).rgb;
        }
    return sum / 4.0;
}

void main() {
    vec2 size = vec2(textureSize(u_picture, 0)), uv = gl_FragCoord.xy / size;
    o_radiance = vec4(u_weight * blurred(u_picture, uv) + textureLod(u_wider, within_view(uv, uv.x, u_wider), 0.0).rgb, 1.0);
}
