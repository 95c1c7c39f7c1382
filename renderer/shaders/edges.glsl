// Provides: what is known of a pixel's four samples, which nobody has shaded: their depth, and a mark
// that tells apart things which meet at one depth. Marks: renderer/frame/outlines.py.

uniform sampler2DMS u_sample_depth;
uniform sampler2DMS u_sample_mark;
uniform vec2 u_depth_step;           // a step of one pixel in depth is x (y - depth)

struct Samples {
    vec4 depth, mark;
    float step;
};

Samples samples_of(ivec2 at) {
    Samples s;
    s.depth = vec4(texelFetch(u_sample_depth, at, 0).r, texelFetch(u_sample_depth, at, 1).r,
                   texelFetch(u_sample_depth, at, 2).r, texelFetch(u_sample_depth, at, 3).r);
    s.mark = 255.0 * vec4(texelFetch(u_sample_mark, at, 0).r, texelFetch(u_sample_mark, at, 1).r,
                          texelFetch(u_sample_mark, at, 2).r, texelFetch(u_sample_mark, at, 3).r);
    s.step = u_depth_step.x * (u_depth_step.y - min(min(s.depth.x, s.depth.y), min(s.depth.z, s.depth.w)));
    return s;
}
