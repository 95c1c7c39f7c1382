// Provides: the iris as a relief: where the bent view ray meets it, and how it shades itself.
// Part of the effect "texture" from high on, where the iris is large enough to show it. Heights are
// mm above the iris plane, which lies at the relief's mean.

uniform sampler2D u_iris_height;   // 0 to 1, without mips
uniform vec2 u_relief_mm;          // of the map: its highest point, its mean

const int RELIEF_STEPS = TEXTURE >= ULTRA ? 5 : 4;
const float SHADE_RANGE = 2.0;  // the shade map's largest value
const float IRIS_WIDTH_MM = 11.7;

// Fades in while the iris grows from 70 to 130 pixels; below, parallax stays within a pixel.
float relief_share() {
    return 1.0 - smoothstep(IRIS_WIDTH_MM / 130.0, IRIS_WIDTH_MM / 70.0, u_mm_per_px);
}

float relief_at(vec2 map_mm) {
    return u_relief_mm.x * textureLod(u_iris_height, plane_uv(map_mm), 0.0).r - u_relief_mm.y;
}

// A short way along the iris, on the maps: stretched along the radius as map_point does.
vec2 map_way(vec2 way_mm, vec2 x_mm, vec2 map_mm) {
    float r = max(length(x_mm), 1e-3);
    vec2 axis = x_mm / r;
    float around = length(map_mm) / r, along = r < 0.5 * u_pupil_mm ? around : tissue_stretch();
    return (around * way_mm + (along - around) * dot(way_mm, axis) * axis) * vec2(u_mirror, 1.0);
}

// Tatarchuk 2006, "Dynamic parallax occlusion mapping": equal steps down through the relief, then
// the straight line between the last two.
vec2 on_relief(vec2 x_mm, vec3 d_eye) {
    vec2 drift = d_eye.xy / max(-d_eye.z, 0.3), map_mm = map_point(x_mm);
    vec2 way = map_way(drift, x_mm, map_mm);
    float stride = u_relief_mm.x / float(RELIEF_STEPS);
    float top = u_relief_mm.x - u_relief_mm.y, found = -u_relief_mm.y, searching = 1.0;
    float room = top - relief_at(map_mm - way * top);
    for (int i = 1; i <= RELIEF_STEPS; ++i) {
        float z = top - stride * float(i);
        float room_here = z - relief_at(map_mm - way * z);
        float meets = searching * step(room_here, 0.0);
        found = mix(found, z - stride * room_here / max(room - room_here, 1e-4), meets);
        searching -= meets;
        room = room_here;
    }
    return x_mm - relief_share() * drift * found;
}

// Share of the sunlight that reaches a point past higher tissue: 1 free, 0 in shade. The sun is an
// edge of light; what scatters in the tissue softens it with distance.
float relief_light(vec2 x_mm, vec3 w_eye) {
    vec2 toward_sun = -w_eye.xy / max(-w_eye.z, 0.35);
    float height = relief_at(map_point(x_mm)), shade = 0.0;
    for (int i = 1; i <= 5; ++i) {
        float rise = 0.009 * float(i * i);
        float over = relief_at(map_point(x_mm + toward_sun * rise)) - height - rise;
        shade = max(shade, over / (0.02 + 0.4 * rise));
    }
    return 1.0 - clamp(shade, 0.0, 1.0);
}

// The relief's cosine relative to the flat plane's, which the irradiance already holds, and its
// shade, for sunlight that travels along w_eye.
float relief_shading(vec2 x_mm, vec3 w_eye) {
    vec2 uv = plane_uv(map_point(x_mm));
    vec3 n = 2.0 * textureLod(u_iris_normal, uv, plane_lod(u_iris_normal)).xyz - 1.0;
    n = stretched(n * vec3(u_mirror, 1.0, 1.0), x_mm);
    float cavity = textureLod(u_iris_albedo, uv, plane_lod(u_iris_albedo)).a;
    float tilted = clamp(dot(n, -w_eye) / max(-w_eye.z, 0.35), 0.0, SHADE_RANGE);
    return tilted * relief_light(x_mm, w_eye) * mix(1.0, cavity, 0.2);
}
