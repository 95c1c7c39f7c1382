// Provides: skin. Baked scattered light times paint, pores and crepe from one tile, two oily lobes.

#include "light.glsl"
#include "specular.glsl"

in vec3 v_world;
in vec3 v_normal;
in vec3 v_albedo;
in vec3 v_diffuse;
in vec4 v_surface;
in vec4 v_detail;
in float v_lid;

uniform vec3 u_camera_mm;
uniform sampler2D u_pores;     // slope x, slope y, cavity, mottle
uniform float u_pore_level;    // mip level of the tile at this distance

out vec4 out_radiance;

const float SKIN_F0 = 0.028;
const vec3 SHARPNESS = vec3(0.35, 0.6, 0.7);  // share of light that does not scatter far

void main() {
    float gloss = v_surface.x, ambient = v_surface.y, sun = v_surface.z, wet = v_surface.w;
    vec3 n = normalize(v_normal);
    vec3 t = normalize(vec3(n.z, 0.0, -n.x));
    vec3 b = cross(n, t);
    vec3 v = normalize(u_camera_mm - v_world);

    vec4 pores = textureLod(u_pores, v_detail.xy, u_pore_level);
    vec4 broad = textureLod(u_pores, v_detail.yx * 0.31 + 0.37, u_pore_level - 1.5);
    vec4 crepe = textureLod(u_pores, v_detail.zw * vec2(0.012, 0.075), u_pore_level + 0.5);
    float dry = 1.0 - wet;
    vec2 slope = (pores.xy - 0.5) * mix(1.3, 0.8, v_lid) + (broad.xy - 0.5) * 0.5;
    slope += (crepe.xy - 0.5) * vec2(0.25, 1.5) * v_lid;
    slope *= dry;
    vec3 n_detail = normalize(n - slope.x * t - slope.y * b);

    vec3 albedo = v_albedo * (1.0 + (pores.a + broad.a - 1.0) * vec3(0.10, 0.17, 0.19) * dry);
    albedo *= mix(1.0, 0.72 + 0.28 * pores.b, dry);
    float n_dot_l = dot(n, u_sun_direction);
    float change = max(dot(n_detail, u_sun_direction), 0.0) - max(n_dot_l, 0.0);
    vec3 diffuse = v_diffuse + u_sun_irradiance / PI * (sun * change) * SHARPNESS;
    vec3 radiance = albedo * max(diffuse, vec3(0.0));

    float rough = mix(0.52, 0.40, gloss), oily = mix(0.34, 0.24, gloss);
    float n_dot_v = max(dot(n_detail, v), 0.02);
    vec3 sunlight = u_sun_irradiance * (sun * max(dot(n_detail, u_sun_direction), 0.0));
    radiance += sunlight * pores.b * (0.75 * ggx(n_detail, v, u_sun_direction, rough, SKIN_F0)
        + 0.55 * gloss * ggx(n_detail, v, u_sun_direction, oily, SKIN_F0));
    vec3 mirrored = reflect(-v, n_detail);
    float fresnel = environment_fresnel(n_dot_v, rough, SKIN_F0);
    radiance += ambient_irradiance(mirrored) / PI * (ambient * ambient * fresnel * (0.6 + 0.4 * gloss));

    if (wet > 0.01) {
        vec3 film = reflect(-v, n);
        radiance += wet * ambient * ambient_irradiance(film) / PI * environment_fresnel(n_dot_v, 0.1, 0.021);
        radiance += wet * min(sunlight * ggx(n, v, u_sun_direction, 0.13, 0.021), vec3(30.0));
    }
    out_radiance = vec4(radiance, 1.0);
}
