// Provides: boxes of the target, with the world direction of each of their points as seen by the camera.

#include "view_direction.glsl"

in vec4 in_box_px;        // x, y, width, height from the lower left

uniform vec2 u_size_px;   // of the viewport
uniform float u_z;        // in clip space
uniform ivec4 u_view;     // x, y, width, height of the camera's picture

out vec3 v_direction;

void main() {
    vec2 at_px = in_box_px.xy + vec2(gl_VertexID & 1, gl_VertexID >> 1) * in_box_px.zw;
    v_direction = view_direction(2.0 * (at_px - vec2(u_view.xy)) / vec2(u_view.zw) - 1.0);
    gl_Position = vec4(2.0 * at_px / u_size_px - 1.0, u_z, 1.0);
}
