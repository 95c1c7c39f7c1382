// Provides: bare positions, for depth maps.

in vec3 in_position;

uniform mat4 u_world_to_clip;

void main() { gl_Position = u_world_to_clip * vec4(in_position, 1.0); }
