// Provides: the crowd's shadow in the sun: posed vertices slid along the light on to level ground.

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform vec3 u_sun_direction;
uniform float u_ground_mm;

in vec3 p_world;

void main() {
    float fall = max(p_world.y - u_ground_mm, 0.0) / max(u_sun_direction.y, 0.1);
    vec3 p_ground = p_world - u_sun_direction * fall;
    gl_Position = u_projection * u_view_matrix * vec4(p_ground.x, u_ground_mm, p_ground.z, 1.0);
}
