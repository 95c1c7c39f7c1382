// Provides: face_direction(uv), the direction of a texel of the cube face being drawn.
// OpenGL 4.3 core, table 8.18: s and t of a face run along its right and down vectors.

uniform mat3 u_face;   // columns: right (s), down (t), forward (major axis), world axes

vec3 face_direction(vec2 uv) {
    vec2 st = uv * 2.0 - 1.0;
    return normalize(u_face * vec3(st, 1.0));
}
