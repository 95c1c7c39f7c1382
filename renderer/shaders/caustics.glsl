// Provides: the effect "caustics": the light that reaches a point of the iris.
// Off, low, medium: the sun's plain cosine, the sky's plain irradiance. High, ultra: the light that
// the cornea lets in and gathers, from maps of this clip (renderer/eye/caustics.py, chamber.py); or, as
// in the thesis, a painted pattern on top of the plain cosine (painted_caustic.py).

#include "eye_chamber.glsl"

uniform sampler2D u_painted_caustic;  // the thesis's pattern, brightest towards +x

struct IrisLight {
    vec3 sun;        // irradiance on the iris plane
    vec3 ambient;
    vec3 w_eye;      // unit, the sunlight's direction of travel at the iris
    vec3 painted;    // radiance that the thesis's pattern adds to a white iris
};

// Sunlight enters where it enters, not where the viewer looks in: go back up to the cornea.
vec3 light_entry(vec2 x_mm, vec3 w_eye) {
    vec3 x = vec3(x_mm, IRIS_Z_MM);
    float height = APEX_MM, slope;
    vec3 p = x;
    for (int i = 0; i < 2; ++i) {
        p = x - w_eye * ((height - IRIS_Z_MM) / max(-w_eye.z, 0.2));
        front_profile(min(length(p.xy), LIMBUS_RADIUS_MM), height, slope);
    }
    return vec3(p.xy, height);
}

// Thesis section 4.6: the map is summed with the iris's colour by the angles of view and light. It
// turns away from the sun, slides outwards and grows brighter as sunlight comes in lower.
vec3 painted_pattern(vec2 x_mm, Surface s, vec3 toward_sun, float reaching) {
    float sine = length(toward_sun.xy), facing = max(dot(s.n_eye, s.v_eye), 0.0);
    vec2 away = -toward_sun.xy / max(sine, 1e-3);
    vec2 turned = vec2(dot(x_mm, away), dot(x_mm, vec2(-away.y, away.x)));
    turned.x += 1.2 * (1.0 - sine);
    float texel_mm = 2.0 * MAP_EDGE_MM / float(textureSize(u_painted_caustic, 0).x);
    float lod = max(log2(u_mm_per_px / (MAGNIFICATION * texel_mm)), 0.0);
    float pattern = textureLod(u_painted_caustic, plane_uv(turned), lod).r;
    return u_sun_irradiance * (reaching * pattern * sine * facing * smoothstep(-0.2, 0.1, toward_sun.z));
}

// The sunlight's direction of travel at the iris: bent where view or light is refracted.
vec3 light_direction(vec2 x_mm) {
    if (REFRACTION < HIGH && CAUSTICS < HIGH) return -turned_to_eye(u_sun_direction);
    vec2 q = caustic_at(x_mm).xy;
    return normalize(vec3(q, -sqrt(max(1.0 - dot(q, q), 0.01))));
}

IrisLight light_on_iris(vec2 x_mm, Surface s) {
    IrisLight light;
    vec3 toward_sun = turned_to_eye(u_sun_direction);
    float reaching = s.sun, gain = max(toward_sun.z, 0.0);
    light.w_eye = light_direction(x_mm);
    light.painted = vec3(0.0);
    light.ambient = plane_irradiance() * s.sky;
    if (CAUSTICS >= HIGH && CAUSTICS_PAINTED == 0) {
        // Radiance falls by n^2 on its way out of the chamber (Nicodemus): counted here, where the
        // way in is counted, so that both stand or fall together.
        float n2 = CORNEA_IOR * CORNEA_IOR;
        gain = caustic_at(x_mm).z / n2;
        light.ambient = chamber_at(x_mm) / n2;
        reaching = shade_at(light_entry(x_mm, light.w_eye)).a;
    }
    if (CAUSTICS >= HIGH && CAUSTICS_PAINTED == 1)
        light.painted = painted_pattern(x_mm, s, toward_sun, reaching);
    light.sun = u_sun_irradiance * gain * reaching;
    return light;
}

// What seeps through the limbus, where a ray misses the iris.
vec3 limbal_radiance(Surface s) {
    float cosine = max(dot(s.n_eye, turned_to_eye(u_sun_direction)), 0.0);
    vec3 ambient = ambient_irradiance(turned_to_world(s.n_eye)) * s.sky;
    return LIMBAL_TISSUE * (u_sun_irradiance * s.sun * cosine + ambient) / PI;
}

// What the relief makes of the sun's light.
float relief_shade(vec2 x_mm) { return TEXTURE < HIGH ? 1.0 : relief_shade_at(x_mm); }
