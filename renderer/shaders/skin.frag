// Provides: skin. Baked scattered light times paint, pores and crepe from one tile, two oily lobes.

#include "light.glsl"
#include "specular.glsl"

in vec3 v_normal;
in vec3 v_half;
in vec3 v_albedo;
in vec3 v_diffuse;
in vec3 v_sheen;
in vec4 v_surface;
in vec4 v_detail;
in float v_lid;

uniform sampler2D u_pores;     // slope x, slope y, cavity, mottle; one level per view

out vec4 out_radiance;

const vec3 SHARPNESS = vec3(0.35, 0.6, 0.7);  // share of light that does not scatter far

void main() {
    float gloss = v_surface.x, sun = v_surface.z, dry = 1.0 - v_surface.w;
    vec3 n = normalize(v_normal);
    vec3 t = vec3(n.z, 0.0, -n.x);
    vec3 b = cross(n, t);

    vec4 pores = textureLod(u_pores, v_detail.xy, 0.0);
    vec2 slope = (pores.xy - 0.5) * (0.95 - 0.3 * v_lid);
    if (v_lid > 0.02) {
        vec4 crepe = textureLod(u_pores, v_detail.zw * vec2(0.026, 0.08), 0.0);
        slope += (crepe.xy - 0.5) * vec2(0.5, 1.3) * v_lid;
    }
    slope *= dry;
    vec3 n_detail = normalize(n - slope.x * t - slope.y * b);

    vec3 albedo = v_albedo * (1.0 + (pores.a - 0.5) * vec3(0.13, 0.20, 0.23) * dry);
    albedo *= 1.0 - 0.2 * dry * (1.0 - pores.b);
    float cosine = max(dot(n_detail, u_sun_direction), 0.0);
    float change = cosine - max(dot(n, u_sun_direction), 0.0);
    vec3 diffuse = v_diffuse + u_sun_irradiance * (sun * change / PI) * SHARPNESS;

    vec3 h = normalize(v_half);
    float n_dot_h = dot(n_detail, h);
    float lobes = 0.75 * gaussian_lobe(n_dot_h, mix(0.52, 0.42, gloss))
        + 0.5 * gloss * gaussian_lobe(n_dot_h, mix(0.36, 0.27, gloss));
    lobes *= pores.b;
    if (dry < 0.99) lobes += (1.0 - dry) * min(gaussian_lobe(dot(n, h), 0.13), 300.0);
    vec3 mirrored = u_sun_irradiance * (v_surface.y * cosine * lobes);
    float cover = 1.0 - (1.0 - dry) * (1.0 - v_lid);
    out_radiance = vec4(albedo * max(diffuse, vec3(0.0)) + mirrored + v_sheen, cover);
}
