// Provides: the effect "refraction": the view ray from the cornea to the iris plane.
// Off, low, medium: straight on to the plane at its true depth. High, ultra: bent by Snell's law,
// weakened by Fresnel's transmittance.

// Taken away from the bending, 0 to 1, while an eye blends with one that does not refract.
uniform float u_unbent;

struct ViewRay {
    vec3 d_eye;         // unit, travelling into the eye
    vec2 x_mm;          // where it meets the iris plane
    float transmitted;  // share of the light that comes back out along it
};

// Cook and Torrance 1982, eq. 4: unpolarised dielectric reflectance, exact.
float fresnel_of(float ior, float c) {
    float g = sqrt(ior * ior - 1.0 + c * c);
    float ratio = (g - c) / (g + c);
    float second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * ratio * ratio * (1.0 + second * second);
}

float fresnel(float c) { return fresnel_of(CORNEA_IOR, c); }

ViewRay view_through_cornea(Surface s) {
    ViewRay ray;
    ray.d_eye = -s.v_eye;
    ray.transmitted = 1.0;
    if (REFRACTION >= HIGH) {
        float c = clamp(dot(s.n_eye, s.v_eye), 0.0, 1.0);
        float ior = mix(CORNEA_IOR, 1.0, u_unbent);
        ray.d_eye = refract(-s.v_eye, s.n_eye, 1.0 / ior);
        ray.transmitted = 1.0 - fresnel_of(ior, c);
    }
    float t = (s.p_eye.z - IRIS_Z_MM) / max(-ray.d_eye.z, 0.03);
    ray.x_mm = s.p_eye.xy + t * ray.d_eye.xy;
    return ray;
}
