// Provides: the fine mesh's picture: coverage and depth from its triangles, radiance from the
// picture that eye.frag has left. Small triangles cost four times their pixels in software GL, so
// the expensive shader never sees them.

uniform sampler2D u_shaded;        // radiance per pixel

out vec4 f_radiance;

void main() {
    f_radiance = vec4(texelFetch(u_shaded, ivec2(gl_FragCoord.xy), 0).rgb, 2.0);
}
