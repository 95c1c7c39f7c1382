// Provides: the world direction, not of unit length, of a place in a camera's picture (-1 to 1).

uniform mat4 u_view_matrix;
uniform mat4 u_projection;

vec3 view_direction(vec2 place) {
    vec3 d_view = vec3((place + vec2(u_projection[2][0], u_projection[2][1]))
                       / vec2(u_projection[0][0], u_projection[1][1]), -1.0);
    return transpose(mat3(u_view_matrix)) * d_view;
}
