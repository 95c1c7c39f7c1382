// Provides: ribbons of hair that face the camera. hair.frag gives each its true width as coverage, so
// that hairs thinner than a pixel neither break nor swell; where they are much thinner, hairs are
// left out by their number and the others stand for them. Lit here, not per pixel: hairs cover few
// pixels each, but the rasteriser visits many for them. LOCK and MARK as in hair.frag.

#include "light.glsl"
#include "fibre.glsl"

in vec3 in_position;
in vec3 in_tangent;   // from root to tip
in vec4 in_ribbon;    // side, half width at the root in mm, place along the hair, thinning number
in vec4 in_colour;    // linear colour; how far a mark hides the skin, 0 for a hair
in float in_sun;      // share of the sun that reaches this place

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform vec3 u_camera_mm;
uniform float u_pixel_per_mm;   // at 1 mm distance
uniform float u_pixel_mm;       // a pixel at the head, the same for all hairs: thinning is steady
uniform float u_least_px;       // thinner hairs are thinned out
uniform vec3 u_middle_mm;       // of the body that locks lie flat on

out vec3 v_body;
out vec3 v_glint;
out vec4 v_ribbon;    // way across in px, half width in px, place along, thinning number
out float v_shadow;

// A pixel whose middle lies beside the hair is partly covered: as far as hair.frag's filters reach.
const float MARGIN_PX = LOCK > 1 || MARK == 1 ? 0.5 : 1.0;
const float SHADOW_LIFT_MM = 0.5;

// A hair swells where it leaves the skin and narrows to a point; a lock thins out strand by strand.
float taper(float along) {
    float root = 0.6 + 0.4 * smoothstep(0.0, 0.08, along);
    return LOCK > 1 ? 1.0 - 0.35 * along * along : root * (1.0 - along * along);
}

void main() {
    vec3 to_camera = u_camera_mm - in_position;
    float distance_mm = length(to_camera);
    vec3 v = to_camera / distance_mm;
    // A hair is as wide from every side; a lock lies flat and is thin at the head's outline.
    vec3 across = cross(in_tangent, LOCK > 1 ? in_position - u_middle_mm : v);
    across /= max(length(across), 1e-4);
    vec3 beside = cross(in_tangent, v);   // across it on the picture
    float end_on = length(beside);
    beside /= max(end_on, 1e-4);
    float shown = dot(across, beside);
    if (shown < 0.0) { beside = -beside; shown = -shown; }
    shown = max(shown, 0.25);
    float pixel_mm = distance_mm / u_pixel_per_mm;
    float kept = min(2.0 * in_ribbon.y / (u_least_px * u_pixel_mm), 1.0);
    float full_px = in_ribbon.y * taper(in_ribbon.z) / (kept * pixel_mm);

    v_shadow = in_colour.a;
    float half_px = shown * full_px;
    // A lock seen end-on would be a blot.
    if (LOCK > 1) half_px *= smoothstep(0.02, 0.2, end_on);
    v_ribbon = vec4(in_ribbon.x * (half_px + MARGIN_PX), half_px, in_ribbon.z, in_ribbon.w);
    bool is_drawn = in_ribbon.w <= kept;
    bool is_black = MARK == 1 && in_colour.r == 0.0;   // a shadow
    FibreLight light = FibreLight(vec3(0.0), vec3(0.0));
    if (is_drawn && !is_black)
        light = fibre_light(in_tangent, v, in_colour.rgb, in_ribbon.z, in_sun);
    v_body = light.body;
    v_glint = light.glint;

    // The ribbon is drawn where its pixels are and lies as deep as the flat lock: a ribbon seen from its
    // edge would miss most pixels' middles and break into dots.
    vec3 reach = beside * (half_px + MARGIN_PX) + v * (dot(across, v) * full_px);
    vec3 p_world = in_position + reach * (in_ribbon.x * pixel_mm);
    if (MARK == 1) p_world += v * SHADOW_LIFT_MM;
    gl_Position = is_drawn ? u_projection * u_view_matrix * vec4(p_world, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
