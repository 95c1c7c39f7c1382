// Provides: the crowd's vertices in their pose, captured into a buffer: linear blend skinning.

uniform mat4 u_bones[23];   // rest pose -> world space, millimetres

in vec3 in_position;
in vec3 in_normal;
in vec4 in_bones;
in vec4 in_weights;

out vec3 p_world;
out vec3 n_world;

void main() {
    mat4 m = in_weights.x * u_bones[int(in_bones.x)] + in_weights.y * u_bones[int(in_bones.y)]
           + in_weights.z * u_bones[int(in_bones.z)] + in_weights.w * u_bones[int(in_bones.w)];
    p_world = (m * vec4(in_position, 1.0)).xyz;
    n_world = normalize(mat3(m) * in_normal);
}
