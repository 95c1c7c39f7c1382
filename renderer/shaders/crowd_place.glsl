// Provides: what eye_place.glsl does, for eyes that are drawn together. Nothing is kept per eye but
// its record: lids shade by formula, the head's shade is one number.

#include "crowd_eyes.glsl"

uniform vec3 u_camera_mm;      // world space
uniform float u_pixel_rad;     // angle of a pixel
uniform sampler2D u_lid_rims;  // a row per eye of each body; per x as in eye_place.glsl

flat in int v_eye;

// Of the eye that a fragment belongs to; named as the uniforms that they stand in for.
mat4 u_eye_to_world;
float u_mm_per_px;
float u_mirror;

const float RIM_EDGE_MM = 18.0;
const float LID_WALL_MM = 1.6;   // as high as a lid's margin is thick
const vec3 SHADE_SEEP = vec3(0.72, 0.98, 1.05);  // renderer/eye/sunlight.py

void place_eye() {
    u_eye_to_world = u_crowd_eyes[v_eye].eye_to_world;
    u_mirror = u_crowd_eyes[v_eye].facts.x;
    u_mm_per_px = distance(u_camera_mm, u_eye_to_world[3].xyz) * u_pixel_rad;
}

vec4 rims_at(float x_mm) {
    vec4 lids = u_crowd_eyes[v_eye].lids;
    float row = (lids.x + 0.5) / float(textureSize(u_lid_rims, 0).y);
    vec4 rims = textureLod(u_lid_rims, vec2(0.5 + 0.5 * (x_mm + lids.y) / RIM_EDGE_MM, row), 0.0);
    return rims - vec4(lids.zz, 0.0, 0.0);
}

vec2 past_lids_and_lashes(vec3 p_eye, vec3 d_eye, float softness_mm);

float sun_past_lids(vec3 p_eye, float softness_mm) {
    vec3 toward_sun = transpose(mat3(u_eye_to_world)) * u_sun_direction;
    return u_crowd_eyes[v_eye].facts.z * past_lids_and_lashes(p_eye, toward_sun, softness_mm).x;
}

// Two walls, one per lid, leave (1 + d / sqrt(d^2 + h^2)) / 2 of the sky at a distance d; skin
// fills the rest, so shade is red.
vec3 sky_past_lids(vec3 p_eye) {
    vec4 rims = rims_at(p_eye.x);
    vec2 d = max(vec2(rims.x - p_eye.y, p_eye.y - rims.y), 0.0);
    vec2 open_share = 0.5 + 0.5 * d * inversesqrt(d * d + LID_WALL_MM * LID_WALL_MM);
    return pow(vec3(open_share.x * open_share.y), vec3(0.75, 0.95, 1.0));
}

vec4 shade_at(vec3 p_eye) {
    return vec4(u_crowd_eyes[v_eye].facts.w * sky_past_lids(p_eye), sun_past_lids(p_eye, 0.35));
}

vec3 scattered_sun_at(vec3 p_eye) { return pow(vec3(sun_past_lids(p_eye, 0.7)), SHADE_SEEP); }

vec3 plane_irradiance() { return ambient_irradiance(u_eye_to_world[2].xyz); }
