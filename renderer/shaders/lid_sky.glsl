// Provides: what the lids and their lashes leave of the sky's light on the globe, summed over the
// hemisphere of a point. For a map that is drawn once per clip. Needs light.glsl, lids.glsl.

const int SKY_RAYS = 64;
const float SKY_SOFTNESS_MM = 0.8;  // the lids' rounded edges, and what 64 rays can tell
const float DIMMEST = 1e-3;         // radiance: the harmonics of a clear sky dip below zero

// The surroundings' radiance from their first nine harmonics (Ramamoorthi and Hanrahan 2001).
vec3 sky_radiance(vec3 d) {
    vec3 l = 0.282095 * u_ambient_sh[0]
           + 0.488603 * (d.y * u_ambient_sh[1] + d.z * u_ambient_sh[2] + d.x * u_ambient_sh[3])
           + 1.092548 * (d.x * d.y * u_ambient_sh[4] + d.y * d.z * u_ambient_sh[5] + d.x * d.z * u_ambient_sh[7])
           + 0.315392 * (3.0 * d.z * d.z - 1.0) * u_ambient_sh[6]
           + 0.546274 * (d.x * d.x - d.y * d.y) * u_ambient_sh[8];
    return max(l, vec3(DIMMEST));
}

// Share of a ray that lashes take on average, as lash_cover does for single hairs.
float mean_lash_cover(vec3 at, vec3 d_eye, float room_mm) {
    float climb = d_eye.y / max(d_eye.z, 0.05);
    float root2 = climb * climb - 4.0 * LASH_CURL * room_mm;
    if (climb <= 0.0 || root2 <= 0.0 || room_mm > LASH_ROOM_MM) return 0.0;
    float way = max((climb - sqrt(root2)) / (2.0 * LASH_CURL), 0.0) / LASH_REACH_MM;
    float hairs = 2.0 * 0.9 * LASH_HALF_MM * LASHES_PER_MM;  // seen square on
    // A ray along the hairs passes more of them than one across.
    float slant = min(inversesqrt(max(1.0 - d_eye.z * d_eye.z, 0.04)), 2.5);
    float along = 1.0 - smoothstep(LASH_END_MM - 1.5, LASH_END_MM, abs(at.x));
    return along * min(hairs * slant * max(1.0 - way * way, 0.0), 0.9);
}

// x past the lids, y past the lashes.
vec2 sky_past_lids(vec3 p_eye, vec3 d_eye) {
    float along = dot(p_eye, d_eye);
    float reach = -along + sqrt(max(along * along - dot(p_eye, p_eye) + LID_FRONT_MM * LID_FRONT_MM, 0.0));
    vec3 at = p_eye + reach * d_eye;
    vec4 rims = rims_at(at.x);
    float room = min(rims.x - at.y, at.y - rims.y), soft = SKY_SOFTNESS_MM + 0.12 * reach;
    return vec2(smoothstep(-soft, soft, room), 1.0 - mean_lash_cover(at, d_eye, rims.x - at.y));
}

// Share of the ambient irradiance that a point keeps, per channel: skin fills what the lids hide.
vec3 sky_share(vec3 p_eye, vec3 n_eye) {
    vec3 side = normalize(cross(n_eye, vec3(0.0, 1.0, 0.1))), up = cross(side, n_eye);
    vec3 around = ambient_irradiance(turned_to_world(vec3(0.0, 0.0, 1.0))) * (0.5 / PI);
    vec3 all = vec3(0.0), kept = vec3(0.0);
    for (int i = 0; i < SKY_RAYS; ++i) {
        // A spiral of cosine-weighted directions, a golden angle apart.
        float sine2 = (float(i) + 0.5) / float(SKY_RAYS), turn = 2.399963 * float(i);
        vec3 d = sqrt(sine2) * (cos(turn) * side + sin(turn) * up) + sqrt(1.0 - sine2) * n_eye;
        vec3 sky = sky_radiance(turned_to_world(d));
        vec2 past = sky_past_lids(p_eye, d);
        all += sky;
        kept += mix(LID_REFLECTANCE * around, mix(LASH_REFLECTANCE * around, sky, past.y), past.x);
    }
    return min(kept / all, vec3(1.0));
}
