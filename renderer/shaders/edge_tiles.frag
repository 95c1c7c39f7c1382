// Provides: which tiles of a picture may have edges, four to a texel (lower left, lower right, upper
// left, upper right), from what was drawn with one sample per pixel: where the picture bends or
// falls in depth, or its marks change. A tile without them where nothing was drawn is OPEN. It reads
// every other pixel of every other row: an edge is longer than that. TILE_PX is a tile's width.

uniform sampler2D u_radiance;   // its alpha tells marks
uniform sampler2D u_depth;
uniform ivec4 u_view;           // x, y, width, height of what these tiles lie in
uniform int u_first_column;     // of these tiles
uniform vec2 u_depth_step;      // a step of one pixel in depth is x (y - depth)

out vec4 o_found;

// In pixels of depth, over two pixels to either side. find_edges.frag asks for a fall of 5 within a
// pixel; planes fall evenly, so a bend tells edges from slopes.
const float BEND_PX = 3.0, FALL_PX = 20.0;
const float OPEN = 0.5;

struct Row {
    float before, after;
    vec4 a, b;
};

// Within the view: beyond it lies another.
ivec2 place(int column, int row, ivec2 first) {
    return clamp(first + ivec2(column, row), u_view.xy, u_view.xy + u_view.zw - 1);
}

float depth_at(int column, int row, ivec2 first) { return texelFetch(u_depth, place(column, row, first), 0).r; }

float mark_at(int column, int row, ivec2 first) { return texelFetch(u_radiance, place(column, row, first), 0).a; }

Row depths(int row, ivec2 first) {
    return Row(depth_at(-2, row, first), depth_at(16, row, first),
        vec4(depth_at(0, row, first), depth_at(2, row, first), depth_at(4, row, first), depth_at(6, row, first)),
        vec4(depth_at(8, row, first), depth_at(10, row, first), depth_at(12, row, first), depth_at(14, row, first)));
}

Row marks(int row, ivec2 first) {
    return Row(0.0, mark_at(16, row, first),
        vec4(mark_at(0, row, first), mark_at(2, row, first), mark_at(4, row, first), mark_at(6, row, first)),
        vec4(mark_at(8, row, first), mark_at(10, row, first), mark_at(12, row, first), mark_at(14, row, first)));
}

// How far beyond what is even, for four pixels and their neighbours.
vec4 excess(vec4 here, vec4 left, vec4 right, vec4 below, vec4 above) {
    vec4 bend = max(abs(left + right - 2.0 * here), abs(below + above - 2.0 * here));
    vec4 fall = max(abs(right - left), abs(above - below));
    vec4 pixel = u_depth_step.x * (u_depth_step.y - here);
    return max(bend - BEND_PX * pixel, fall - FALL_PX * pixel);
}

float largest(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy) - ivec2(u_first_column, 0);
    ivec2 first = u_view.xy + 2 * TILE_PX * block;
    Row below = depths(-2, first), here = depths(0, first), mark = marks(0, first);
    vec4 most = vec4(0.0), farthest = vec4(0.0);
    for (int row = 2; row <= 2 * TILE_PX; row += 2) {
        Row above = depths(row, first), next = marks(row, first);
        vec4 a = excess(here.a, vec4(here.before, here.a.xyz), vec4(here.a.yzw, here.b.x), below.a, above.a);
        vec4 b = excess(here.b, vec4(here.a.w, here.b.xyz), vec4(here.b.yzw, here.after), below.b, above.b);
        a = max(a, max(abs(mark.a - next.a), abs(mark.a - vec4(mark.a.yzw, mark.b.x))));
        b = max(b, max(abs(mark.b - next.b), abs(mark.b - vec4(mark.b.yzw, mark.after))));
        vec2 here_most = vec2(largest(a), largest(b)), far = vec2(largest(here.a), largest(here.b));
        // The row belongs to the lower tiles or to the upper ones.
        most = max(most, row <= TILE_PX ? vec4(here_most, 0.0, 0.0) : vec4(0.0, 0.0, here_most));
        farthest = max(farthest, row <= TILE_PX ? vec4(far, 0.0, 0.0) : vec4(0.0, 0.0, far));
        below = here;
        here = above;
        mark = next;
    }
    o_found = max(vec4(greaterThan(most, vec4(0.0))), OPEN * vec4(greaterThanEqual(farthest, vec4(1.0))));
}
