// Provides: reading a level of the bloom's pyramid without crossing from one view to the next.

uniform int u_views;   // pictures that stand side by side

// A point as far as it stays half a texel within the view that another point lies in.
vec2 within_view(vec2 uv, float of_x, sampler2D picture) {
    float views = float(u_views), edge = 0.5 / float(textureSize(picture, 0).x);
    float view = min(floor(of_x * views), views - 1.0);
    uv.x = clamp(uv.x, view / views + edge, (view + 1.0) / views - edge);
    return uv;
}
