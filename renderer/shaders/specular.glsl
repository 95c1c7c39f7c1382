// Provides: the specular lobes of rough dielectrics, for the sun and for smooth surroundings.

const float PI = 3.14159265358979;

// Beckmann's lobe as a spherical Gaussian (Wang et al. 2009); the normal distribution D.
float gaussian_lobe(float n_dot_h, float roughness) {
    float m = roughness * roughness, m2 = m * m;
    return exp2(2.885390 * (n_dot_h - 1.0) / m2) / (PI * m2);
}

// Schlick 1994.
float schlick(float cosine, float f0) {
    float c = 1.0 - cosine, c2 = c * c;
    return f0 + (1.0 - f0) * c2 * c2 * c;
}

// Share of smooth surroundings that a rough dielectric mirrors (fit after Karis 2014).
float environment_fresnel(float NoV, float roughness, float f0) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * NoV)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a004 + r.zw;
    return f0 * ab.x + ab.y;
}
