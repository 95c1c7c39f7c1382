// Provides: the skin's vertices. Light that does not change over a clip arrives baked per vertex.

in vec3 in_position;
in vec3 in_normal;
in vec3 in_albedo;
in vec3 in_diffuse;   // radiance that a white skin would send back, scattering included
in vec4 in_surface;   // gloss, ambient visibility, sun visibility, wetness
in vec4 in_detail;    // pore tile's coordinates, lid's coordinates in mm
in float in_lid;      // 1 on the lids' crepe

uniform mat4 u_view_matrix;
uniform mat4 u_projection;

out vec3 v_world;
out vec3 v_normal;
out vec3 v_albedo;
out vec3 v_diffuse;
out vec4 v_surface;
out vec4 v_detail;
out float v_lid;

void main() {
    v_world = in_position;
    v_normal = in_normal;
    v_albedo = in_albedo;
    v_diffuse = in_diffuse;
    v_surface = in_surface;
    v_detail = in_detail;
    v_lid = in_lid;
    gl_Position = u_projection * u_view_matrix * vec4(in_position, 1.0);
}
