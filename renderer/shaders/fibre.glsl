// Provides: sunlight and skylight that a hair sends to the eye. World space; needs light.glsl.

struct FibreLight {
    vec3 body;     // scattered and let through
    vec3 glint;    // mirrored by the front (white) and by the back (in the hair's colour)
};

const float INV_PI = 0.318309886;
// Marschner et al. 2003, table 1: the scales of the cuticle lean towards the tip by 5 to 10 degrees
// and are rough by as much; a double pass is twice as rough, and comes back on the other side.
const float SCALES = 0.105;
const float ROUGH = 0.15;
const float F0 = 0.0465;         // hair's index is 1.55

float along_lobe(float angle, float width) {
    return exp(-0.5 * angle * angle / (width * width)) / (2.5066283 * width);
}

// Marschner et al. 2003 with the azimuthal fits of Karis 2016, "Physically based hair shading in
// Unreal". A tip is thin and lets more light through than the shaft;
// the root is the youngest and darkest.
FibreLight fibre_light(vec3 t, vec3 v, vec3 colour, float along, float sun) {
    colour = pow(colour, vec3(1.06 - 0.46 * along * along));
    vec3 l = u_sun_direction;
    float sin_l = clamp(dot(t, l), -1.0, 1.0), sin_v = clamp(dot(t, v), -1.0, 1.0);
    float lean = 0.5 * (asin(sin_l) + asin(sin_v));
    float half_turn = 0.5 * (asin(sin_v) - asin(sin_l));
    float cos_d = cos(half_turn);
    vec3 l_flat = l - sin_l * t, v_flat = v - sin_v * t;
    float cos_phi = dot(l_flat, v_flat) * inversesqrt(max(dot(l_flat, l_flat) * dot(v_flat, v_flat), 1e-6));

    float cosine = sqrt(max(0.5 + 0.5 * dot(l, v), 0.0));
    float f_front = F0 + (1.0 - F0) * pow(1.0 - cosine, 5.0);
    float f_side = F0 + (1.0 - F0) * pow(1.0 - 0.5 * cos_d, 5.0);
    float mirrored = along_lobe(lean + SCALES, ROUGH) * f_front * 0.25 * sqrt(max(0.5 + 0.5 * cos_phi, 0.0));
    vec3 through = pow(colour, vec3(0.45 / cos_d))
        * (along_lobe(lean - 0.5 * SCALES, 0.5 * ROUGH) * exp(-3.65 * cos_phi - 3.98) * (1.0 - F0) * (1.0 - F0));
    vec3 returned = pow(colour, vec3(0.8 / cos_d))
        * (along_lobe(lean - 1.5 * SCALES, 2.0 * ROUGH) * exp(17.0 * cos_phi - 16.78)
           * (1.0 - f_side) * (1.0 - f_side) * f_side);

    float cos_l = sqrt(max(1.0 - sin_l * sin_l, 0.0));
    vec3 irradiance = u_sun_irradiance * (sun * cos_l);
    vec3 facing = normalize(v_flat + vec3(1e-4));
    vec3 sky = ambient_irradiance(facing) * INV_PI;
    vec3 above = ambient_irradiance(vec3(0.0, 1.0, 0.0)) * INV_PI;
    float spread = 1.0 / (cos_d * cos_d);
    FibreLight light;
    light.body = colour * (irradiance * (0.55 * INV_PI) + 0.8 * sky) + through * irradiance * spread;
    // The sky above as one wide light: the sheen that hairs in the shade have.
    float under_sky = 0.5 * (asin(clamp(t.y, -1.0, 1.0)) + asin(sin_v));
    light.glint = (mirrored + returned) * irradiance * spread
        + (0.005 + 0.012 * exp(-under_sky * under_sky * 5.0)) * above;
    return light;
}
