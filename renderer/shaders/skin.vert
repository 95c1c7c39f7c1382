// Provides: the skin's vertices. Light that does not change over a clip arrives baked per vertex;
// what changes slowly over the skin (mirrored sky, Fresnel) is evaluated here, not per pixel.

#include "light.glsl"
#include "specular.glsl"

in vec3 in_position;
in vec3 in_normal;
in vec3 in_albedo;
in vec3 in_diffuse;   // radiance that a white skin would send back, scattering included
in vec4 in_surface;   // gloss, ambient visibility, sun visibility, wetness (conjunctiva: 1 - grain / 2)
in vec4 in_detail;    // pore tile's coordinates, lid's coordinates, on conjunctiva below 0
in float in_lid;      // 1 on the lids' crepe; where tears stand, how much is covered

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform vec3 u_camera_mm;
uniform float u_slope_range;   // slopes run from minus to plus this
uniform float u_colour_scale;  // from the relief's tiles to the colour's
uniform vec2 u_lost_variance;  // of the slopes that the levels no longer show: face, lids
uniform float u_mark;          // of what is drawn, for outlines

// What a draw leaves alone. Software GL fetches a uniform for every pixel, what is flat for eight.
flat out vec3 v_sun_direction;
flat out vec3 v_sun_irradiance;
flat out vec4 v_maps;   // u_slope_range, u_colour_scale, u_lost_variance
flat out float v_mark;
out vec3 v_world;
out vec3 v_normal;
out vec3 v_half;      // between the view and the sun
out vec3 v_albedo;
out vec3 v_diffuse;
out vec3 v_sheen;     // mirrored sky
out vec4 v_surface;   // gloss, strength of the sun's mirror image, sun visibility, wetness
out vec4 v_detail;
out vec4 v_lid;       // in_lid; how much of the relief shows; shares of face and lid in it, or
                      // of granules and -1 on conjunctiva

const float SKIN_F0 = 0.028;
const float TEAR_F0 = 0.021;
const float GRAIN = 1.6;      // how much steeper the caruncle's granules are than the cheek's relief

void main() {
    float gloss = in_surface.x, ambient = in_surface.y, sun = in_surface.z, wet = in_surface.w;
    vec3 n = in_normal;
    vec3 v = normalize(u_camera_mm - in_position);
    vec3 h = normalize(v + u_sun_direction);
    float n_dot_v = max(dot(n, v), 0.05), l_dot_h = max(dot(u_sun_direction, h), 0.1);
    vec3 mirrored = ambient_irradiance(reflect(-v, n)) / PI * ambient;
    v_sheen = mirrored * (ambient * environment_fresnel(n_dot_v, 0.45, SKIN_F0) * (0.6 + 0.4 * gloss)
        + wet * environment_fresnel(n_dot_v, 0.1, TEAR_F0));
    // Kelemen and Szirmay-Kalos 2001: visibility over the cosines is about 1 / (4 (l h)^2).
    float strength = sun * schlick(l_dot_h, SKIN_F0) / (4.0 * l_dot_h * l_dot_h);
    v_sun_direction = u_sun_direction;
    v_sun_irradiance = u_sun_irradiance;
    v_maps = vec4(u_slope_range, u_colour_scale, u_lost_variance);
    v_mark = u_mark;
    v_world = in_position;
    v_normal = n;
    v_half = h;
    v_albedo = in_albedo;
    v_diffuse = in_diffuse;
    v_surface = vec4(gloss, strength, sun, wet);
    v_detail = in_detail;
    // Where the view grazes, relief is finer than pixels: less of it shows. Where two reliefs mix, their
    // variances add up to one's (Heitz and Neyret 2018), or smooth skin would lie between them.
    v_lid = vec4(in_lid, mix(0.3, 1.0, smoothstep(0.05, 0.4, dot(n, v))),
        vec2(1.0 - in_lid, in_lid) * inversesqrt(1.0 - 2.0 * in_lid * (1.0 - in_lid)));
    if (in_detail.z < 0.0) {
        v_lid.zw = vec2(GRAIN * 2.0 * (1.0 - wet), -1.0);
        v_surface.w = 1.0;
    }
    gl_Position = u_projection * u_view_matrix * vec4(in_position, 1.0);
}
