// Provides: what the eyelids and their lashes take from the globe: sunlight, ambient light,
// reflections. Eye space in millimetres. The rims are the lids' inner edges (renderer/eye/lids.py).
// Needs surface.glsl.

const float LID_FRONT_MM = 13.4;   // radius of the lids' middle surface, which rays pass or hit
const vec3 LID_REFLECTANCE = vec3(0.38, 0.24, 0.18);  // skin
const vec3 LASH_REFLECTANCE = vec3(0.02, 0.012, 0.008);

// Whether a point of the globe, or its neighbourhood, can lie open to view. Lids may be modelled a
// little wider than their rims say.
bool between_lids(vec3 p_eye) {
    // An eye that looks far aside shows parts behind its own equator, where rims are but a guess.
    float margin_mm = p_eye.z < 0.0 ? 3.0 : 1.5;
    vec4 rims = rims_at(p_eye.x);
    return p_eye.z > -8.0 && p_eye.y < rims.x + margin_mm && p_eye.y > rims.y - margin_mm;
}

// The upper lid's lashes as rays meet them (renderer/head/lashes.py grows the ones that are seen):
// from the rim they stand off the globe, fan out with it and curl up like a parabola.
const float LASH_REACH_MM = 7.2;   // forwards, at most
const float LASH_CURL = 0.09;      // height over the rim = LASH_CURL * way^2, per mm
const float LASH_FAN = 0.09;       // sideways per mm of way and mm off the middle
const float LASH_HALF_MM = 0.03;
const float LASHES_PER_MM = 6.0;   // in all rows
const float LASH_END_MM = 12.2;    // off the middle
const float LASH_ROOM_MM = 12.0;   // below the rim no ray is that meets them: no eye opens wider
const int LASH_ROWS = 3;

// Four numbers of 0 to 1 from a cell's (Jenkins's mix, the same on every renderer).
vec4 lash_chance(int cell, int row) {
    uint h = uint(cell * 4 + row + 4096);
    h = (h ^ 61u) ^ (h >> 16); h *= 9u; h ^= h >> 4; h *= 0x27d4eb2du; h ^= h >> 15;
    return vec4(uvec4(h, h >> 8, h >> 16, h >> 24) & 255u) / 255.0;
}

// Share of a beam, ``blur_mm`` wide to each side, that hairs take ``way_mm`` from their roots.
float lash_hairs(float root_mm, float way_mm, float blur_mm) {
    float open_share = 1.0;
    // Tufts: towards their tips hairs crowd and leave gaps, and some cross.
    float tip = way_mm / LASH_REACH_MM;
    root_mm += tip * (0.30 * sin(4.3 * root_mm + 1.3) + 0.16 * sin(9.7 * root_mm + 5.0 * tip));
    for (int row = 0; row < LASH_ROWS; ++row) {
        float at = root_mm * (LASHES_PER_MM / float(LASH_ROWS)) + 0.37 * float(row);
        vec4 chance = lash_chance(int(floor(at)), row);
        float reach = LASH_REACH_MM * (0.35 + 0.65 * chance.y);
        float sway = (chance.z - 0.5) * 0.5 * tip;
        float d = (fract(at) - 0.5 - 0.5 * (chance.x - 0.5) - sway) * float(LASH_ROWS) / LASHES_PER_MM;
        float half_mm = LASH_HALF_MM * (0.4 + chance.w) * max(1.0 - way_mm * way_mm / (reach * reach), 0.0);
        float taken = max(min(half_mm, d + blur_mm) - max(-half_mm, d - blur_mm), 0.0) / (2.0 * blur_mm);
        float mean = 2.0 * half_mm * LASHES_PER_MM / float(LASH_ROWS);
        open_share *= 1.0 - mix(taken, mean, smoothstep(0.05, 0.25, blur_mm));
    }
    return 1.0 - open_share;
}

// Share of a ray's beam that upper lashes take after it passed the lids' front ``at``, ``room_mm``
// below the rim. It meets them where it has climbed as high as they have.
float lash_cover(vec3 at, vec3 d_eye, float room_mm, float reach_mm) {
    float climb = d_eye.y / max(d_eye.z, 0.05);
    float root2 = climb * climb - 4.0 * LASH_CURL * room_mm;
    if (climb <= 0.0 || root2 <= 0.0 || room_mm < -2.0 || room_mm > LASH_ROOM_MM) return 0.0;
    float way = max((climb - sqrt(root2)) / (2.0 * LASH_CURL), 0.0);
    if (way > LASH_REACH_MM) return 0.0;
    float root_mm = (at.x + way * d_eye.x / max(d_eye.z, 0.05)) / (1.0 + LASH_FAN * way);
    // Half the sun's width, or a pixel's cone in the cornea's mirror.
    float blur_mm = 0.03 + (0.018 + u_mm_per_px / CORNEA_RADIUS_MM) * (reach_mm + way);
    float along = 1.0 - smoothstep(LASH_END_MM - 1.5, LASH_END_MM, abs(root_mm));
    return along * lash_hairs(root_mm, way, blur_mm);
}

// What lets a ray pass: x 1 between the lids, 0 where it meets one; y 1 past the lashes.
// renderer/eye/lids.py, lid_openness, says the same without lashes: it gathers whole skies.
vec2 past_lids_and_lashes(vec3 p_eye, vec3 d_eye, float softness_mm) {
    float along = dot(p_eye, d_eye);
    float excess = dot(p_eye, p_eye) - LID_FRONT_MM * LID_FRONT_MM;
    float reach = max(-along + sqrt(max(along * along - excess, 0.0)), 0.0);
    vec3 at = p_eye + reach * d_eye;
    vec4 rims = rims_at(at.x);
    softness_mm += 0.12 * reach;  // grazing rays meet a rounded edge, not a line
    float room = min(rims.x - at.y, at.y - rims.y);
    float past_lids = smoothstep(-softness_mm, softness_mm, room);
    return vec2(past_lids, 1.0 - lash_cover(at, d_eye, rims.x - at.y, reach));
}

// Share of the sun that reaches a point of the globe, past this eye's lids and the whole head.
float sun_reaching(vec3 p_eye, vec3 toward_sun) {
    vec2 past = past_lids_and_lashes(p_eye, toward_sun, 0.35);
    if (past.x * past.y <= 0.0) return 0.0;
    return min(past.x * past.y, sun_visibility(world_from_eye(p_eye), 0.6));
}
