// Provides: the crowd's radiance: Lambert under sun and sky, and the shine of wet eyes and of hair.

#include "light.glsl"

uniform vec3 u_camera_mm;

in vec3 v_position;
in vec3 v_normal;
in vec4 v_surface;   // albedo; 1 on wet eyes, renderer/crowd/hair.py's SHEEN on hair, else 0
in vec3 v_ambient;
in float v_sun;
flat in float v_mark;

out vec4 o_radiance;   // premultiplied by coverage, which is 1; in the picture 1 and the mark

const float STRANDS = 75.0;   // radians of light and dark per unit of the last channel

void main() {
    const float pi = 3.14159265359;
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);
    float NoL = max(dot(n, u_sun_direction), 0.0) * v_sun;
    vec3 radiance = v_surface.rgb * (u_sun_irradiance * NoL + v_ambient) / pi;
    float strand_px = STRANDS * fwidth(v_surface.a);
    if (v_surface.a > 0.1) {
        // Normalised Blinn-Phong. Tear film: exponent 300, F0 0.021. Hair: broad, index 1.55, less what
        // the hairs' sides lose.
        bool is_wet = v_surface.a > 0.5;
        float exponent = is_wet ? 300.0 : 18.0, f0 = is_wet ? 0.021 : 0.017;
        vec3 h = normalize(u_sun_direction + normalize(u_camera_mm - v_position));
        float lobe = (exponent + 8.0) / (8.0 * pi) * pow(max(dot(n, h), 0.0), exponent);
        // The last channel runs from a lock's furrow to its ridge: strands are lines of equal value.
        float strand = sin(STRANDS * v_surface.a) * clamp(1.4 - strand_px, 0.0, 1.0);
        if (!is_wet) radiance *= 1.0 + 0.35 * strand;
        radiance += f0 * (u_sun_irradiance * lobe * NoL + v_ambient / pi);
    }
    o_radiance = vec4(radiance, 1.0 + v_mark);
}
