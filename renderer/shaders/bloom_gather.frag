// Provides: the picture's radiance at a quarter of its width. Every other row: glints are wider than
// that, and software GL waits longer for a picture's rows than for what it does with them. PX is how
// many picture pixels a texel is wide.

uniform sampler2D u_radiance;
uniform int u_wide;       // pixels of one view
uniform int u_columns;    // texels of one view

out vec4 o_radiance;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    // Software GL divides whole numbers one at a time.
    int view = int(gl_FragCoord.x / float(u_columns));
    ivec2 first = ivec2(view * u_wide + (texel.x - view * u_columns) * PX, texel.y * PX);
    ivec2 last = ivec2((view + 1) * u_wide, textureSize(u_radiance, 0).y) - 1;
    vec3 sum = vec3(0.0);
    for (int j = 0; j < PX; j += 2)
        for (int i = 0; i < PX; ++i)
            sum += texelFetch(u_radiance, min(first + ivec2(i, j), last), 0).rgb;
    o_radiance = vec4(2.0 * sum / float(PX * PX), 1.0);
}
