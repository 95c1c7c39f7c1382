// Provides: the tear line's vertices. World space in millimetres.

in vec3 in_position;
in vec3 in_normal;
in vec3 in_tangent;    // along the lid
in vec3 in_water;      // 0 on the globe .. 1 on the lid; amount of water; gloss

uniform mat4 u_view_matrix;
uniform mat4 u_projection;

out vec3 v_world;
out vec3 v_normal;
out vec3 v_tangent;
out vec3 v_water;

void main() {
    v_world = in_position;
    v_normal = in_normal;
    v_tangent = in_tangent;
    v_water = in_water;
    gl_Position = u_projection * u_view_matrix * vec4(in_position, 1.0);
}
