// Provides: where the eye is, and what lids and light leave of sun and sky on it, from maps of the
// clip. crowd_place.glsl says the same of many eyes that are drawn together.

uniform mat4 u_eye_to_world;
uniform vec3 u_camera_mm;      // world space
uniform float u_mm_per_px;     // size of a pixel at the eye
uniform float u_mirror;        // +1 the viewer's left eye, -1 the right: flips maps in x
uniform vec3 u_plane_irradiance;  // ambient, on the iris's plane without lids
uniform sampler2D u_lid_rims;  // per x: y of upper, y of lower, z of upper, z of lower rim
uniform sampler2D u_shade_map;
uniform sampler2D u_scattered_sun;   // the shade map's sun as tissue spreads it, per channel

const float RIM_EDGE_MM = 18.0;      // half the width that the rims' table covers

void place_eye() {}

vec4 rims_at(float x_mm) {
    return textureLod(u_lid_rims, vec2(0.5 + 0.5 * x_mm / RIM_EDGE_MM, 0.5), 0.0);
}

// What sun (a) and sky (rgb) reach a point of the globe's front.
vec4 shade_at(vec3 p_eye) {
    return textureLod(u_shade_map, 0.5 + 0.5 * p_eye.xy / GLOBE_RADIUS_MM, 0.0);
}

// Share of the sun that the white sends back: it seeps into the lids' shade, red furthest.
vec3 scattered_sun_at(vec3 p_eye) {
    return textureLod(u_scattered_sun, 0.5 + 0.5 * p_eye.xy / GLOBE_RADIUS_MM, 0.0).rgb;
}

vec3 plane_irradiance() { return u_plane_irradiance; }
