// Provides: the wet surface: the film's normal over cornea and sclera, the limbus's uneven edge.
// Sclera high, ultra: the conjunctiva's fine relief breaks up what the film mirrors. Reflection
// high, ultra: faint waves on the cornea. renderer/eye/micro_relief.py makes the tile.

uniform sampler2D u_micro_relief;  // slopes along u and v, mean square slope, a smooth field

const float CORNEA_WAVES = 0.022;        // of the sclera's relief: 0.15 degrees
const float LIMBUS_UNEVENNESS_MM = 0.016;
const vec3 LIMBAL_RING = vec3(0.66, 0.70, 0.76);  // what thin tissue over the dark angle returns

vec4 relief_tile(vec2 at_mm) {
    float texel_mm = RELIEF_TILE_MM / float(textureSize(u_micro_relief, 0).x);
    float lod = max(log2(u_mm_per_px / texel_mm), 0.0);
    vec4 tile = textureLod(u_micro_relief, at_mm / RELIEF_TILE_MM, lod);
    vec2 slope = RELIEF_SLOPE_RANGE * (2.0 * tile.xy - 1.0);
    float square = RELIEF_SLOPE_RANGE * RELIEF_SLOPE_RANGE * tile.z;
    return vec4(slope, max(0.5 * (square - dot(slope, slope)), 0.0), tile.a);
}

// The sclera does not end on an ellipse: its edge wanders.
float uneven(float cornea, float field) {
    float shift = LIMBUS_UNEVENNESS_MM / LIMBUS_WIDTH_MM * (field - 0.5) / 0.2;
    return cornea / (cornea + (1.0 - cornea) * exp(shift));
}

Surface with_waves(Surface s) {
    if (SCLERA < HIGH && REFLECTION < HIGH) return s;
    vec4 tile = relief_tile(s.p_eye.xy);
    if (SCLERA >= HIGH) s.cornea = uneven(s.cornea, tile.w);
    if (REFLECTION >= HIGH) {
        float strength = CORNEA_WAVES * s.cornea;
        s.n_film = normalize(s.n_eye + vec3(strength * tile.xy, 0.0));
        s.film_variance = strength * strength * tile.z;
    }
    return s;
}

// Where the sclera thins out over the dark chamber angle, light is lost: the dark ring that stays
// at the limbus from every side.
vec3 limbal_ring(Surface s) {
    if (SCLERA < HIGH) return vec3(1.0);
    float edge = 4.0 * s.cornea * (1.0 - s.cornea);
    return mix(vec3(1.0), LIMBAL_RING, edge * edge);
}
