// Provides: the look of one hair (Kajiya and Kay 1989, with a second, tinted highlight).

#include "light.glsl"

in vec3 v_world;
in vec3 v_tangent;
in vec3 v_colour;
in vec4 v_hair;

uniform vec3 u_camera_mm;

out vec4 out_radiance;

float lobe(float cosine, float exponent) {
    return pow(max(1.0 - cosine * cosine, 0.0), 0.5 * exponent);
}

void main() {
    vec3 t = normalize(v_tangent);
    vec3 v = normalize(u_camera_mm - v_world);
    vec3 h = normalize(v + u_sun_direction);
    float t_dot_l = dot(t, u_sun_direction);
    float diffuse = sqrt(max(1.0 - t_dot_l * t_dot_l, 0.0));
    vec3 sun = u_sun_irradiance * v_hair.w;
    vec3 facing = normalize(v - t * dot(t, v));
    vec3 sky = ambient_irradiance(facing) * 0.3183;
    vec3 radiance = v_colour * (sun * (0.3183 * 0.6 * diffuse) + sky);
    float t_dot_h = dot(t, h);
    radiance += sun * (0.030 * lobe(t_dot_h + 0.06, 90.0)
        + 1.6 * v_colour * lobe(t_dot_h - 0.12, 24.0));
    radiance += sky * 0.02;
    out_radiance = vec4(radiance, v_hair.z);
}
