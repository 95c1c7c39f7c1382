// Provides: where the picture has edges, told by depth: software GL computes both sides of an if, but
// skips the pixels that fail the next pass's test of depth.

#include "edges.glsl"

const float EDGE_PX = 5.0;   // even a surface at 80 degrees falls by less from sample to sample

void main() {
    Samples s = samples_of(ivec2(gl_FragCoord.xy));
    float near = min(min(s.depth.x, s.depth.y), min(s.depth.z, s.depth.w));
    float far = max(max(s.depth.x, s.depth.y), max(s.depth.z, s.depth.w));
    bool is_edge = far - near > EDGE_PX * s.step || any(notEqual(s.mark, s.mark.yzwx));
    gl_FragDepth = is_edge ? 0.0 : 1.0;
}
