// Provides: the globe's vertices in eye space. World space in millimetres.

in vec3 in_position;  // eye space, mm
in vec3 in_normal;

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform mat4 u_eye_to_world;

out vec3 v_p_eye;
out vec3 v_n_eye;

void main() {
    v_p_eye = in_position;
    v_n_eye = in_normal;
    gl_Position = u_projection * u_view_matrix * u_eye_to_world * vec4(in_position, 1.0);
}
