// Provides: the tear line: what its hollow face mirrors of sun and sky, and the dark thread at its
// upper edge where the water bends the view aside. Premultiplied: the rest shines through.

#include "light.glsl"
#include "specular.glsl"

in vec3 v_world;
in vec3 v_normal;
in vec2 v_water;

uniform vec3 u_camera_mm;
uniform float u_mm_per_px;    // size of a pixel at the eye

out vec4 out_radiance;

const float TEAR_F0 = 0.021;
const float RADIUS_MM = 0.28;        // of the hollow: the normal turns by a radian over this way
const float RIPPLE = 0.11;           // slopes of the water, root mean square: lashes and mucus
const float EDGE_SHADE = 0.30;       // what the upper edge takes away
const float HEIGHT_MM = 0.35;        // of the strip, from globe to lid

// Share of the strip's width that a line of the water's own width keeps once pixels are wider.
float coverage() { return min(HEIGHT_MM / u_mm_per_px, 1.0); }

vec3 sun_mirrored(vec3 n, vec3 v) {
    vec3 h = normalize(v + u_sun_direction);
    float turn = 0.5 * u_mm_per_px / RADIUS_MM;
    float roughness = sqrt(sqrt(2.0) * length(vec2(RIPPLE, min(turn, 0.6))));
    float l_dot_h = max(dot(u_sun_direction, h), 0.1);
    float lobe = gaussian_lobe(dot(n, h), roughness) / (4.0 * l_dot_h * l_dot_h);
    float lit = max(dot(n, u_sun_direction), 0.0) * sun_visibility(v_world, 0.6);
    return u_sun_irradiance * (schlick(l_dot_h, TEAR_F0) * lobe * lit);
}

void main() {
    vec3 v = normalize(u_camera_mm - v_world);
    vec3 n = normalize(v_normal);
    float n_dot_v = clamp(dot(n, v), 0.05, 1.0);
    float fresnel = schlick(n_dot_v, TEAR_F0);
    vec3 r = reflect(-v, n);
    // The sky stands over the horizon; below it lashes, cheek and ground are darker.
    float open_share = smoothstep(-0.35, 0.35, r.y) * smoothstep(-0.2, 0.3, r.z);
    vec3 mirrored = fresnel * mix(0.25, 1.0, open_share) * ambient_irradiance(r) / PI;
    float edge = 1.0 - smoothstep(0.0, 0.35, v_water.x);
    float amount = v_water.y * coverage();
    float taken = fresnel + EDGE_SHADE * edge * (1.0 - edge) * 4.0;
    out_radiance = amount * vec4(mirrored + sun_mirrored(n, v), taken);
}
