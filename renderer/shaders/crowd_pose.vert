// Provides: the crowd's vertices in their pose, captured into a buffer: linear blend skinning.

uniform sampler2D u_bones;   // rest pose -> world space, millimetres: a row per bone, its columns

in vec3 in_position;
in vec3 in_normal;
in vec4 in_bones;            // everybody's bones are numbered through
in vec4 in_weights;

out vec3 p_world;
out vec3 n_world;

mat4 bone(float number) {
    int row = int(number);
    return mat4(texelFetch(u_bones, ivec2(0, row), 0), texelFetch(u_bones, ivec2(1, row), 0),
                texelFetch(u_bones, ivec2(2, row), 0), texelFetch(u_bones, ivec2(3, row), 0));
}

void main() {
    mat4 m = in_weights.x * bone(in_bones.x) + in_weights.y * bone(in_bones.y)
           + in_weights.z * bone(in_bones.z) + in_weights.w * bone(in_bones.w);
    p_world = (m * vec4(in_position, 1.0)).xyz;
    n_world = normalize(mat3(m) * in_normal);
}
