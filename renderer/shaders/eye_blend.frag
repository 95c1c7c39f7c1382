// Provides: an eye between two LoDs, from the pictures that eye.frag has left of both. Their alpha
// says where their meshes lie: by the silhouette one may have a pixel that the other has not.

uniform sampler2D u_coarse;        // radiance per pixel
uniform sampler2D u_fine;
uniform float u_share;             // of the finer LoD

out vec4 f_radiance;

// Alpha 1 where the picture shows the eye.
vec4 shown(sampler2D picture, ivec2 at) {
    vec4 texel = texelFetch(picture, at, 0);
    return vec4(texel.rgb, min(texel.a, 1.0));
}

// Premultiplied; a pixel that the mesh only grazes has its neighbours' mean.
vec4 around(sampler2D picture, ivec2 at) {
    vec4 here = shown(picture, at);
    int is_bare = here.a > 0.0 ? 0 : 1;
    for (int i = 0; i < 9 * is_bare; ++i) {
        here += shown(picture, at + ivec2(i % 3, i / 3) - 1);
    }
    return here / max(here.a, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 sum = (1.0 - u_share) * around(u_coarse, at) + u_share * around(u_fine, at);
    f_radiance = vec4(sum.rgb / max(sum.a, 1e-6), 2.0);
}
