// Provides: boxes of the target, all in one call; positions follow from the vertex number.

in vec4 in_box_px;        // x, y, width, height from the lower left

uniform vec2 u_size_px;   // of the viewport
uniform float u_z;        // in clip space

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(2.0 * (in_box_px.xy + corner * in_box_px.zw) / u_size_px - 1.0, u_z, 1.0);
}
