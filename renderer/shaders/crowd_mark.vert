// Provides: the crowd's posed vertices with the marks of their parts, for outlines.

in vec3 p_world;
in float in_mark;

uniform mat4 u_world_to_clip;

flat out float v_mark;

void main() {
    v_mark = in_mark;
    gl_Position = u_world_to_clip * vec4(p_world, 1.0);
}
