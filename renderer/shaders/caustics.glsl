// Provides: the effect "caustics": the light that reaches a point of the iris.
// Off, low, medium: the sun's plain cosine, the sky's plain irradiance. High, ultra: the light that
// the cornea lets in and gathers, from maps of this clip (renderer/eye/caustics.py, chamber.py).

uniform sampler2D u_caustic_map;   // light's direction x, y; gain of irradiance
uniform sampler2D u_chamber_map;   // irradiance of the surroundings inside the chamber

struct IrisLight {
    vec3 sun;        // irradiance on the iris plane
    vec3 ambient;
    vec3 w_eye;      // unit, the sunlight's direction of travel at the iris
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

IrisLight light_on_iris(vec2 x_mm, Surface s) {
    IrisLight light;
    vec3 toward_sun = turned_to_eye(u_sun_direction);
    float reaching = s.sun;
    float gain = max(toward_sun.z, 0.0);
    light.w_eye = -toward_sun;
    light.ambient = ambient_irradiance(turned_to_world(vec3(0.0, 0.0, 1.0))) * s.sky;
    if (REFRACTION >= HIGH || CAUSTICS >= HIGH) {
        vec3 q = textureLod(u_caustic_map, plane_uv(x_mm), plane_lod(u_caustic_map)).rgb;
        light.w_eye = normalize(vec3(q.xy, -sqrt(max(1.0 - dot(q.xy, q.xy), 0.01))));
        if (CAUSTICS >= HIGH) {
            // Radiance falls by n^2 on its way out of the chamber (Nicodemus): counted here, where
            // the way in is counted, so that both stand or fall together.
            gain = q.z / (CORNEA_IOR * CORNEA_IOR);
            light.ambient = textureLod(u_chamber_map, plane_uv(x_mm), 0.0).rgb
                          / (CORNEA_IOR * CORNEA_IOR);
            reaching = shade_at(light_entry(x_mm, light.w_eye)).a;
        }
    }
    light.sun = u_sun_irradiance * gain * reaching;
    return light;
}

// What seeps through the limbus, where a ray misses the iris.
vec3 limbal_radiance(Surface s) {
    float cosine = max(dot(s.n_eye, turned_to_eye(u_sun_direction)), 0.0);
    vec3 ambient = ambient_irradiance(turned_to_world(s.n_eye)) * s.sky;
    return LIMBAL_TISSUE * (u_sun_irradiance * s.sun * cosine + ambient) / PI;
}

// The relief's cosine relative to the flat plane's, which the irradiance already holds.
float relief_shading(IrisTexel texel, IrisLight light) {
    if (TEXTURE < HIGH) return 1.0;
    float flat_cosine = max(-light.w_eye.z, 0.35);
    return clamp(dot(texel.n_eye, -light.w_eye) / flat_cosine, 0.0, 1.8) * mix(1.0, texel.cavity, 0.5);
}
