// Provides: ribbons of hair that face the camera, never thinner than a pixel: thinner hairs become
// transparent, and where even a quarter is too much, hairs are left out by their number. Lit here,
// not per pixel: hairs cover few pixels each, but the rasteriser visits many for them.

#include "light.glsl"

in vec3 in_position;
in vec3 in_tangent;
in vec4 in_ribbon;    // side, half width at the root in mm, place along the hair, thinning number
in vec3 in_colour;
in float in_sun;      // share of the sun that reaches this place

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform vec3 u_camera_mm;
uniform float u_pixel_per_mm;   // at 1 mm distance
uniform float u_pixel_mm;       // a pixel at the head, the same for all hairs

out vec3 v_radiance;
out vec3 v_hair;      // side, number, alpha

const float LEAST_ALPHA = 0.25;   // one of four samples
const float INV_PI = 0.318309886;

float lobe(float cosine, float exponent) {
    return pow(max(1.0 - cosine * cosine, 0.0), 0.5 * exponent);
}

// Kajiya and Kay 1989, with a second highlight in the hair's own colour (Marschner et al. 2003).
vec3 hair_radiance(vec3 t, vec3 v) {
    vec3 h = normalize(v + u_sun_direction);
    float t_dot_l = dot(t, u_sun_direction), t_dot_h = dot(t, h);
    vec3 sun = u_sun_irradiance * in_sun;
    vec3 facing = normalize(v - t * dot(t, v) + vec3(1e-4));
    vec3 sky = ambient_irradiance(facing) * INV_PI;
    float diffuse = 0.6 * INV_PI * sqrt(max(1.0 - t_dot_l * t_dot_l, 0.0));
    vec3 mirrored = sun * (0.030 * lobe(t_dot_h + 0.06, 90.0)
        + 1.6 * in_colour * lobe(t_dot_h - 0.12, 24.0));
    return in_colour * (sun * diffuse + sky) + mirrored + sky * 0.02;
}

void main() {
    vec3 to_camera = u_camera_mm - in_position;
    float distance_mm = length(to_camera);
    vec3 v = to_camera / distance_mm;
    vec3 across = cross(in_tangent, v);
    across /= max(length(across), 1e-4);
    float pixel_mm = distance_mm / u_pixel_per_mm;
    float taper = 1.0 - 0.85 * in_ribbon.z * in_ribbon.z;
    float mean_alpha = min(1.5 * in_ribbon.y / u_pixel_mm, 1.0);
    bool is_drawn = in_ribbon.w * LEAST_ALPHA <= mean_alpha;
    // Hairs wider than a pixel fade where they taper below it.
    float tip = mean_alpha < 1.0 ? 1.0 : min(2.0 * in_ribbon.y * taper / pixel_mm, 1.0);
    float half_mm = max(in_ribbon.y * taper, 0.5 * pixel_mm);
    v_radiance = hair_radiance(in_tangent, v);
    v_hair = vec3(in_ribbon.x, in_ribbon.w, max(mean_alpha * tip, LEAST_ALPHA));
    vec3 p_world = in_position + across * (in_ribbon.x * half_mm);
    gl_Position = is_drawn ? u_projection * u_view_matrix * vec4(p_world, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
