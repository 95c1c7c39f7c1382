// Provides: a triangle that covers the target at the far plane, with the world direction of each
// of its points as seen by the camera (not of unit length).

uniform mat4 u_view_matrix;
uniform mat4 u_projection;

out vec3 v_direction;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    vec3 d_view = vec3((corner + vec2(u_projection[0][2], u_projection[1][2]))
                       / vec2(u_projection[0][0], u_projection[1][1]), -1.0);
    v_direction = transpose(mat3(u_view_matrix)) * d_view;
    gl_Position = vec4(corner, 1.0, 1.0);
}
