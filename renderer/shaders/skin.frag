// Provides: skin. Baked scattered light times paint; relief from the face's tile and the lids' own
// map, blood and melanin from a third picture; two oily lobes that the relief breaks up.
// LIDS 0: no lids near, their map is not read. WET 0: no tears either, and nothing lets light through.

#include "specular.glsl"

flat in vec3 v_sun_direction;
flat in vec3 v_sun_irradiance;
flat in vec4 v_maps;           // range of slopes; scale of the colour's tile; slopes' lost variance
flat in float v_mark;
in vec3 v_normal;
in vec3 v_half;
in vec3 v_albedo;
in vec3 v_diffuse;
in vec3 v_sheen;
in vec4 v_surface;
in vec4 v_detail;
in vec4 v_lid;

uniform sampler2D u_relief;    // slope x, slope y, openness, mottle; one level per view
uniform sampler2D u_lids;      // slope x, slope y, openness, blood
uniform sampler2D u_colour;    // blood, melanin, oil, strength of the relief

out vec4 out_radiance;

// How much of a facet's own light leaves where it entered: red has wandered off (d'Eon and Luebke
// 2007), so the relief shades blue more than red.
const vec3 SHARPNESS = vec3(0.30, 0.62, 0.75);
const vec3 CAVITY = vec3(0.22, 0.42, 0.48);  // light lost at the bottom of furrows; red bleeds in
const vec3 BLOOD = vec3(0.10, 0.46, 0.42);   // absorption per unit of the maps
const vec3 MELANIN = vec3(0.34, 0.50, 0.62);
const float SKYLINE = 0.55;                  // how much more light a facet gets that tilts upwards
const float VESSELS = 0.5, FLUSH = 0.3;      // of conjunctiva, against the lids' and the face's
const float WET_FOLLOWS = 0.7;               // how much of the relief a film of tears shows
const float FACET_M2 = 0.045, OILY_M2 = 0.0085;  // Beckmann's m^2 of the two lobes, relief apart

// Tears fill the finest furrows; over granules their film is broken and mirrors in many places.
float wet_lobe(vec3 n, vec3 h, float grain) {
    float n_dot_h = dot(n, h);
    float film = min(gaussian_lobe(n_dot_h, 0.13), 300.0);
    return mix(film, 0.30 * min(film, 60.0) + 0.7 * gaussian_lobe(n_dot_h, 0.36), grain);
}

void main() {
    // Samples at a silhouette extrapolate what the vertices say: keep shares within 0 to 1.
    vec4 surface = clamp(v_surface, 0.0, 1.0);
    float gloss = surface.x, sun = surface.z, lid = clamp(v_lid.x, 0.0, 1.0);
    float dry = WET == 1 ? 1.0 - surface.w : 1.0;
    vec3 n = normalize(v_normal);
    vec3 t = vec3(n.z, 0.0, -n.x) * inversesqrt(max(1.0 - n.y * n.y, 1e-4));
    vec3 b = cross(n, t);

    vec4 face = textureLod(u_relief, v_detail.xy, 0.0);
    vec4 crepe = LIDS == 1 ? textureLod(u_lids, v_detail.zw, 0.0) : vec4(0.5);
    vec4 colour = textureLod(u_colour, v_detail.xy * v_maps.y, 0.0) - 0.5;
    vec2 share = LIDS == 1 ? clamp(v_lid.zw, 0.0, 2.0) : vec2(1.0, 0.0);
    bool is_conjunctiva = WET == 1 && v_lid.w < 0.0;
    float thin = LIDS == 1 ? share.y / max(share.x + share.y, 1e-3) : 0.0, grain = min(share.x, 1.0) * (1.0 - dry);
    float conjunctiva = WET == 1 ? VESSELS * clamp(-v_lid.w, 0.0, 1.0) * (1.0 - grain) : 0.0;
    share.x *= 1.0 + 1.6 * colour.a;
    float shown = clamp(v_lid.y, 0.0, 1.0);
    if (is_conjunctiva) face = vec4(1.0 - face.xy, 1.0, face.a);  // granules stand out, pores do not
    vec2 slope = ((face.xy - 0.5) * share.x + (crepe.xy - 0.5) * share.y) * (2.0 * v_maps.x * shown);
    float rugged = shown * min(share.x + share.y, 1.0) * (1.0 - 0.4 * grain);
    float open = 1.0 - rugged * (1.0 - mix(face.z, crepe.z, thin));
    vec2 lost = v_maps.zw + (1.0 - shown * shown) * 0.03;
    float rough = 2.0 * mix(lost.x, lost.y, thin) * dry;  // Beckmann: m^2 is twice the variance

    float flush = is_conjunctiva ? FLUSH : 1.0;
    float blood = colour.r * (flush + 2.0 * grain) + (crepe.a - 0.5) * (thin + conjunctiva);
    float melanin = dry * (colour.g + 0.6 * shown * (face.a - 0.5));
    vec3 albedo = v_albedo * (1.0 - blood * BLOOD - melanin * MELANIN);
    albedo *= 1.0 - CAVITY * (1.0 - open);

    vec3 n_detail = normalize(n - slope.x * t - slope.y * b);
    float cosine = max(dot(n_detail, v_sun_direction), 0.0);
    float change = cosine - max(dot(n, v_sun_direction), 0.0);
    float upwards = n_detail.y - n.y;
    vec3 diffuse = v_diffuse * (1.0 + SKYLINE * upwards * SHARPNESS)
        + v_sun_irradiance * (sun * change / PI) * SHARPNESS;

    vec3 h = normalize(v_half);
    float n_dot_h = dot(n_detail, h), oil = gloss * max(1.0 + 2.4 * colour.b, 0.0);
    float facet_m2 = FACET_M2 + rough, oily_m2 = OILY_M2 + rough;
    float lobes = (0.70 / PI) * exp2(2.885390 * (n_dot_h - 1.0) / facet_m2) / facet_m2
        + (0.50 / PI) * oil * exp2(2.885390 * (n_dot_h - 1.0) / oily_m2) / oily_m2;
    lobes *= open * open;
    if (WET == 1) lobes += (1.0 - dry) * wet_lobe(normalize(mix(n, n_detail, WET_FOLLOWS)), h, grain);
    vec3 mirrored = v_sun_irradiance * (max(v_surface.y, 0.0) * cosine * lobes);
    vec3 sheen = v_sheen * (open * max(1.0 + 2.0 * upwards, 0.0));
    // Clamped: at edges of triangles varyings are extrapolated to the pixel's middle.
    float cover = WET == 1 ? clamp(1.0 - (1.0 - dry) * (1.0 - lid), 0.0, 1.0) : 1.0 + v_mark;
    vec3 radiance = max(albedo * max(diffuse, vec3(0.0)) + mirrored + sheen, vec3(0.0));
    out_radiance = vec4(radiance, cover);
}
