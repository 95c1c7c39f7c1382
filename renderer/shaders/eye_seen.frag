// Provides: which pixels of an eye nothing hides. Their depth becomes 1, so that a test of depth lets
// only them be shaded.

uniform sampler2D u_depth;   // of what was drawn before

out vec4 f_radiance;

const float SLACK = 1e-6;    // a hundredth of a pixel's width: what touches the eye hides none of it

void main() {
    if (gl_FragCoord.z > texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).r + SLACK) discard;
    f_radiance = vec4(0.0);
    gl_FragDepth = 1.0;
}
