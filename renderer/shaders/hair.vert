// Provides: ribbons of hair that face the camera, never thinner than a pixel: thinner hairs become
// transparent, and where even a quarter is too much, hairs are left out by their number.

#include "light.glsl"

in vec3 in_position;
in vec3 in_tangent;
in vec4 in_ribbon;    // side, half width at the root in mm, place along the hair, thinning number
in vec3 in_colour;

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform vec3 u_camera_mm;
uniform float u_pixel_per_mm;   // at 1 mm distance
uniform float u_pixel_mm;       // a pixel at the head, the same for all hairs
uniform float u_shadow_bias_mm;

out vec3 v_world;
out vec3 v_tangent;
out vec3 v_colour;
out vec4 v_hair;      // side, place along, alpha, sun

const float LEAST_ALPHA = 0.25;   // one of four samples

void main() {
    vec3 to_camera = u_camera_mm - in_position;
    float distance_mm = length(to_camera);
    vec3 across = cross(in_tangent, to_camera / distance_mm);
    across /= max(length(across), 1e-4);
    float pixel_mm = distance_mm / u_pixel_per_mm;
    float taper = 1.0 - 0.85 * in_ribbon.z * in_ribbon.z;
    float mean_alpha = min(1.5 * in_ribbon.y / u_pixel_mm, 1.0);
    bool is_drawn = in_ribbon.w * LEAST_ALPHA <= mean_alpha;
    // Hairs wider than a pixel fade where they taper below it.
    float tip = mean_alpha < 1.0 ? 1.0 : min(2.0 * in_ribbon.y * taper / pixel_mm, 1.0);
    float alpha = max(mean_alpha * tip, LEAST_ALPHA);
    float half_mm = max(in_ribbon.y * taper, 0.5 * pixel_mm);
    v_world = in_position + across * (in_ribbon.x * half_mm);
    v_tangent = in_tangent;
    v_colour = in_colour;
    v_hair = vec4(in_ribbon.x, in_ribbon.z, alpha, sun_visibility(in_position, u_shadow_bias_mm));
    gl_Position = is_drawn ? u_projection * u_view_matrix * vec4(v_world, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
