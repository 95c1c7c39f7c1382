// Provides: the globe's surface (Baker's cornea joined to the sclera), frames, common numbers.
// Eye space in millimetres: origin the globe's centre, +z the gaze, +x the viewer's right.

const float PI = 3.14159265358979;

#include "eye_place.glsl"

struct Surface {
    vec3 p_eye;
    vec3 n_eye;      // unit, outwards
    vec3 v_eye;      // unit, towards the camera
    float cornea;    // 1 clear cornea .. 0 opaque sclera
    float limbus_mm; // outwards from where clear tissue ends, which wanders
    float upright;   // 0 at the limbus's sides .. 1 above and below
    vec3 albedo;     // of the sclera
    vec3 n_tissue;   // unit, of the sclera under the film
    vec3 n_film;     // unit, of the tear film with its fine relief
    float film_variance;  // of the film's slope within a pixel, per axis
    float sun;       // share of the sun that reaches it
    vec3 sky;        // share of the sky that it sees past the lids
};

vec3 world_from_eye(vec3 p_eye) { return (u_eye_to_world * vec4(p_eye, 1.0)).xyz; }
vec3 turned_to_world(vec3 d_eye) { return mat3(u_eye_to_world) * d_eye; }
vec3 turned_to_eye(vec3 d_world) { return transpose(mat3(u_eye_to_world)) * d_world; }

// Height and slope of the front surface; renderer/eye/optics.py, surface_height, says the same.
void front_profile(float r, out float height, out float slope) {
    const float R = CORNEA_RADIUS_MM, p = CORNEA_ASPHERICITY;
    float sag = (R - sqrt(max(R * R - p * r * r, 0.0))) / p;
    float cornea = APEX_MM - sag;
    float globe = sqrt(max(GLOBE_RADIUS_MM * GLOBE_RADIUS_MM - r * r, 1e-4));
    float offset = (r - LIMBUS_RADIUS_MM) / JOIN_REACH_MM;
    float k = JOIN_HEIGHT_MM * exp(-offset * offset * offset * offset);
    float k_slope = -4.0 * offset * offset * offset / JOIN_REACH_MM * k;
    float q = sqrt((cornea - globe) * (cornea - globe) + k * k) + 1e-20;
    float weight = 0.5 * (1.0 + (cornea - globe) / q);
    height = 0.5 * (cornea + globe + q);
    slope = -weight * r / (R - p * sag) - (1.0 - weight) * r / globe + 0.5 * k * k_slope / q;
}

// How clear the tissue over a point is: the sclera overlaps the cornea by about a millimetre, and
// further above and below than at the sides.
float cornea_share(vec3 p_eye) {
    if (p_eye.z < 0.0) return 0.0;
    float r = length(vec2(p_eye.x, p_eye.y / LIMBUS_HEIGHT_RATIO));
    return 1.0 / (1.0 + exp((r - LIMBUS_RADIUS_MM + LIMBUS_INSET_MM) / LIMBUS_WIDTH_MM));
}
