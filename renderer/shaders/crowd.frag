// Provides: the crowd's radiance: Lambert under sun and sky, and the shine of wet eyes.

#include "light.glsl"

uniform vec3 u_camera_mm;

in vec3 v_position;
in vec3 v_normal;
in vec4 v_surface;
in vec3 v_ambient;
in float v_sun;
flat in float v_mark;

out vec4 o_radiance;   // premultiplied by coverage, which is 1; in the picture 1 and the mark

void main() {
    const float pi = 3.14159265359;
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);
    float NoL = max(dot(n, u_sun_direction), 0.0) * v_sun;
    vec3 radiance = v_surface.rgb * (u_sun_irradiance * NoL + v_ambient) / pi;
    if (v_surface.a > 0.5) {
        // Normalised Blinn-Phong, exponent 300; F0 of the tear film 0.021.
        vec3 h = normalize(u_sun_direction + normalize(u_camera_mm - v_position));
        float lobe = (300.0 + 8.0) / (8.0 * pi) * pow(max(dot(n, h), 0.0), 300.0);
        radiance += 0.021 * (u_sun_irradiance * lobe * NoL + v_ambient / pi);
    }
    o_radiance = vec4(radiance, 1.0 + v_mark);
}
