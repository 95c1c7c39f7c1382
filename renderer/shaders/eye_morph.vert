// Provides: the globe's vertices between the shapes of two LoDs. Eye space in millimetres.

in vec3 in_coarse_mm;
in vec3 in_fine_mm;

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform mat4 u_eye_to_world;
uniform float u_share;             // of the finer LoD

void main() {
    vec3 p_eye = mix(in_coarse_mm, in_fine_mm, u_share);
    gl_Position = u_projection * u_view_matrix * u_eye_to_world * vec4(p_eye, 1.0);
}
