// Provides: the specular lobe of rough dielectrics, for the sun and for smooth surroundings.

const float PI = 3.14159265358979;

// GGX with height-correlated Smith masking (Heitz 2014) and Schlick's Fresnel, times 1; the caller
// multiplies by irradiance (radiance times the cosine).
float ggx(vec3 n, vec3 v, vec3 l, float roughness, float f0) {
    vec3 h = normalize(v + l);
    float a = roughness * roughness, a2 = a * a;
    float NoH = max(dot(n, h), 0.0), NoV = max(dot(n, v), 0.02), NoL = max(dot(n, l), 0.0);
    float d = NoH * NoH * (a2 - 1.0) + 1.0;
    float D = a2 / (PI * d * d);
    float smith = NoL * sqrt(NoV * NoV * (1.0 - a2) + a2) + NoV * sqrt(NoL * NoL * (1.0 - a2) + a2);
    float c = 1.0 - max(dot(v, h), 0.0), c2 = c * c;
    return D * 0.5 / max(smith, 1e-4) * (f0 + (1.0 - f0) * c2 * c2 * c);
}

// Share of smooth surroundings that a rough dielectric mirrors (fit after Karis 2014).
float environment_fresnel(float NoV, float roughness, float f0) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * NoV)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a004 + r.zw;
    return f0 * ab.x + ab.y;
}
