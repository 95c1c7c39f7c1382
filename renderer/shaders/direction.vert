// Provides: a triangle that covers the target at the far plane, with the world direction of each
// of its points as seen by the camera.

#include "view_direction.glsl"

out vec3 v_direction;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_direction = view_direction(corner);
    gl_Position = vec4(corner, 1.0, 1.0);
}
