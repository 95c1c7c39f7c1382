// Provides: the crowd's posed vertices on the picture or on a cube face, with ambient light.

#include "light.glsl"

uniform mat4 u_view_matrix;
uniform mat4 u_projection;

in vec3 p_world;
in vec3 n_world;
in vec4 in_surface;   // albedo, gloss
in vec2 in_light;     // openness to the sky, visibility of the sun
in float in_mark;     // of the part, for outlines

uniform float u_marked;   // 1 in the picture, 0 in a cube, where alpha is coverage

out vec3 v_position;
out vec3 v_normal;
out vec4 v_surface;
out vec3 v_ambient;
out float v_sun;
flat out float v_mark;

void main() {
    v_position = p_world;
    v_normal = n_world;
    v_surface = in_surface;
    v_ambient = ambient_irradiance(n_world) * in_light.x;
    v_sun = in_light.y;
    v_mark = u_marked * in_mark;
    gl_Position = u_projection * u_view_matrix * vec4(p_world, 1.0);
}
