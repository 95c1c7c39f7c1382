// Provides: what sun and sky reach each point of the globe's front, once per clip: a map over x and
// y of eye space. rgb: share of the sky past the lids; a: share of the sun past lids and head.

#include "light.glsl"
#include "surface.glsl"
#include "lids.glsl"
#include "lid_sky.glsl"

uniform int u_map_px;

out vec4 f_shade;

void main() {
    vec2 xy = (gl_FragCoord.xy / float(u_map_px) * 2.0 - 1.0) * GLOBE_RADIUS_MM;
    float r = min(length(xy), 0.995 * GLOBE_RADIUS_MM), height, slope;
    xy *= r / max(length(xy), 1e-5);
    front_profile(min(r, PROFILE_END_MM), height, slope);
    bool is_globe = r >= PROFILE_END_MM;
    if (is_globe) height = sqrt(GLOBE_RADIUS_MM * GLOBE_RADIUS_MM - r * r);
    vec3 p_eye = vec3(xy, height);
    vec3 n_eye = is_globe ? p_eye : vec3(-slope * xy / max(r, 1e-5), 1.0);
    f_shade = vec4(vec3(0.5), 0.0);
    if (between_lids(p_eye))
        f_shade = vec4(sky_share(p_eye, normalize(n_eye)),
                       sun_reaching(p_eye, turned_to_eye(u_sun_direction)));
}
