// Provides: the knitted sweater. Baked skylight, the sun's shadow per pixel, ribs from one tile, a soft sheen of wool.

#include "light.glsl"

in vec3 v_normal;
in vec3 v_sheen;
in vec3 v_albedo;
in vec3 v_diffuse;
in vec3 v_world;
in vec4 v_detail;

uniform float u_mark;          // for outlines
uniform sampler2D u_knit;      // slope x, slope y, openness, fuzz

out vec4 out_radiance;

const float SHADOW_BIAS_MM = 2.0;

void main() {
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);
    vec3 t = normalize(vec3(n.z, 0.0, -n.x) + vec3(1e-4, 0.0, 0.0));
    vec3 b = cross(n, t);
    vec4 knit = textureLod(u_knit, v_detail.xy * vec2(1.0, 0.25), 0.0);
    vec3 n_knit = normalize(n - (knit.x - 0.5) * 2.0 * t - (knit.y - 0.5) * 1.5 * b);
    float sun = max(dot(n_knit, u_sun_direction), 0.0) * sun_visibility(v_world, SHADOW_BIAS_MM);
    vec3 light = v_diffuse + u_sun_irradiance * (sun / 3.14159265);
    vec3 albedo = v_albedo * (0.4 + 0.75 * knit.z) * (0.7 + 0.6 * knit.w);
    out_radiance = vec4(max(light, vec3(0.0)) * albedo + 0.6 * v_sheen, 1.0 + u_mark);
}
