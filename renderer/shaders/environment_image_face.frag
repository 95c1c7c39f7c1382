// Provides: one face of a static cube map of a user's picture.

#include "cube_face.glsl"
#include "environment_image.glsl"

uniform vec2 u_face_size;

out vec4 o_radiance;

void main() {
    o_radiance = vec4(environment_radiance(face_direction(gl_FragCoord.xy / u_face_size)), 1.0);
}
