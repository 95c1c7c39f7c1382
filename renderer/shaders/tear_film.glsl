// Provides: the wet surface: the film's normal over cornea and sclera, the limbus's uneven edge.
// Sclera high, ultra: the conjunctiva's fine relief breaks up what the film mirrors. Reflection
// high, ultra: faint waves on the cornea. renderer/eye/micro_relief.py makes the tile.

uniform sampler2D u_micro_relief;  // slopes along u and v, mean square slope, a smooth field

const float CORNEA_WAVES = 0.027;        // of the sclera's relief: 0.23 degrees
const float LIMBUS_WANDER_MM = 0.030;             // standard deviation of the edge's way, over millimetres
const float PANNUS = 0.25;                        // how much wider the edge is above and below
const vec3 LIMBAL_RING = vec3(0.50, 0.56, 0.64);  // what thin tissue over the dark angle returns
const vec3 LIMBAL_WHITE = vec3(0.58, 0.65, 0.72); // ... on the white's side: bluer than all white
const vec2 LIMBAL_RING_MM = vec2(0.50, 0.36);     // its reach inwards and outwards

vec4 relief_tile(vec2 at_mm) {
    float texel_mm = RELIEF_TILE_MM / float(textureSize(u_micro_relief, 0).x);
    float lod = max(log2(u_mm_per_px / texel_mm), 0.0);
    vec4 tile = textureLod(u_micro_relief, at_mm / RELIEF_TILE_MM, lod);
    vec2 slope = RELIEF_SLOPE_RANGE * (2.0 * tile.xy - 1.0);
    float square = RELIEF_SLOPE_RANGE * RELIEF_SLOPE_RANGE * tile.z;
    return vec4(slope, max(0.5 * (square - dot(slope, slope)), 0.0), tile.a);
}

// The sclera does not end on an ellipse: its edge wanders, and above and below it thins out further.
Surface with_limbus(Surface s, float field) {
    vec2 around = vec2(s.p_eye.x, s.p_eye.y / LIMBUS_HEIGHT_RATIO);
    float r = max(length(around), 1e-3), wander = (field - 0.5) / 0.2;
    s.upright = around.y * around.y / (r * r);
    s.limbus_mm = r - LIMBUS_RADIUS_MM + LIMBUS_INSET_MM + LIMBUS_WANDER_MM * wander;
    float width = LIMBUS_WIDTH_MM * (1.0 + PANNUS * s.upright + 0.15 * wander);
    if (s.p_eye.z > 0.0) s.cornea = 1.0 / (1.0 + exp(s.limbus_mm / max(width, 0.08)));
    return s;
}

Surface with_waves(Surface s) {
    if (SCLERA < HIGH && REFLECTION < HIGH) return s;
    vec4 tile = relief_tile(s.p_eye.xy);
    if (SCLERA >= HIGH) s = with_limbus(s, tile.w);
    if (REFLECTION >= HIGH) {
        float strength = CORNEA_WAVES * s.cornea;
        s.n_film = normalize(s.n_eye + vec3(strength * tile.xy, 0.0));
        s.film_variance = strength * strength * tile.z;
    }
    return s;
}

// Where the sclera thins out over the dark chamber angle, light is lost: the dark ring that stays at
// the limbus from every side. It fades slowly into the iris, faster into the white.
vec3 limbal_ring(Surface s) {
    if (SCLERA < HIGH) return vec3(1.0);
    float off = s.limbus_mm + 0.1;
    vec3 ring = off < 0.0 ? LIMBAL_RING : mix(LIMBAL_RING, LIMBAL_WHITE, min(off / 0.3, 1.0));
    off /= (off < 0.0 ? LIMBAL_RING_MM.x : LIMBAL_RING_MM.y) * (1.0 + PANNUS * s.upright);
    return mix(vec3(1.0), ring, s.p_eye.z > 0.0 ? exp(-off * off) : 0.0);
}
