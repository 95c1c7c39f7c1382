// Provides: the next smaller level of a cube face: the mean of 2 x 2 texels.

#include "cube_face.glsl"

uniform samplerCube u_source;
uniform vec2 u_face_size;   // of the level being written

out vec4 o_mean;

void main() {
    // The corner that four texels share: a bilinear lookup there is their mean. Level 0 is the
    // texture's base level, which the caller sets to the one to read.
    vec2 st = gl_FragCoord.xy / u_face_size * 2.0 - 1.0;
    o_mean = textureLod(u_source, u_face * vec3(st, 1.0), 0.0);
}
