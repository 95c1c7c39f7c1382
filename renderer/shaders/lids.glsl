// Provides: what the eyelids take from the globe: sunlight, ambient light, reflections.
// Eye space in millimetres. The rims are the lids' inner edges (renderer/eye/lids.py).

uniform sampler2D u_lid_rims;      // per x: y of upper, y of lower, z of upper, z of lower rim

const float RIM_EDGE_MM = 18.0;    // half the width that the rims' table covers
const float LID_FRONT_MM = 13.4;   // radius of the lids' middle surface, which rays pass or hit
const vec3 LID_REFLECTANCE = vec3(0.38, 0.24, 0.18);  // skin

vec4 rims_at(float x_mm) {
    return textureLod(u_lid_rims, vec2(0.5 + 0.5 * x_mm / RIM_EDGE_MM, 0.5), 0.0);
}

// Whether a point of the globe, or its neighbourhood, can lie open to view. Lids may be modelled a
// little wider than their rims say.
bool between_lids(vec3 p_eye) {
    const float margin_mm = 1.0;
    vec4 rims = rims_at(p_eye.x);
    return p_eye.z > -2.0 && p_eye.y < rims.x + margin_mm && p_eye.y > rims.y - margin_mm;
}

// 1 where a ray leaves between the lids, 0 where it meets one (renderer/eye/chamber.py, lid_openness).
float lid_openness(vec3 p_eye, vec3 d_eye, float softness_mm) {
    float along = dot(p_eye, d_eye);
    float excess = dot(p_eye, p_eye) - LID_FRONT_MM * LID_FRONT_MM;
    float reach = max(-along + sqrt(max(along * along - excess, 0.0)), 0.0);
    vec3 at = p_eye + reach * d_eye;
    vec4 rims = rims_at(at.x);
    softness_mm += 0.12 * reach;  // grazing rays meet lashes and a rounded edge, not a line
    float room = min(rims.x - at.y, at.y - rims.y);
    return smoothstep(-softness_mm, softness_mm, room);
}

// Share of the sky that a point of the globe sees past the lids, redder where skin fills the rest:
// (1 + d / sqrt(d^2 + h^2)) / 2 for a wall of height h at distance d, for both lids.
vec3 lid_shade(vec3 p_eye) {
    const float wall_mm = 1.6;
    vec4 rims = rims_at(p_eye.x);
    vec2 d = max(vec2(rims.x - p_eye.y, p_eye.y - rims.y), 0.0);
    vec2 open_share = 0.5 + 0.5 * d * inversesqrt(d * d + wall_mm * wall_mm);
    return pow(vec3(open_share.x * open_share.y), vec3(0.75, 0.95, 1.0));
}

// Share of the sun that reaches a point of the globe, past this eye's lids and the whole head.
float sun_reaching(vec3 p_eye, vec3 toward_sun) {
    float past_lids = lid_openness(p_eye, toward_sun, 0.35);
    if (past_lids <= 0.0) return 0.0;
    return min(past_lids, sun_visibility(world_from_eye(p_eye), 0.6));
}
