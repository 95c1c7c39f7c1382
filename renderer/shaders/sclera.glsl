// Provides: the effect "sclera": colour, relief and diffuse light of the white of the eye.
// Off: mean colour. Low, medium: the diffuse map. High, ultra: the normal map too, whose
// Blinn-Phong highlight is in reflection.glsl.

uniform sampler2D u_sclera_albedo;   // azimuthal equidistant about the gaze axis
uniform sampler2D u_sclera_normal;
uniform vec3 u_sclera_mean;

const float SCLERA_EDGE = 1.91986218;           // 110 degrees: where the maps end
const vec3 SCATTER_WRAP = vec3(0.30, 0.17, 0.12);  // light bleeds past the terminator, red furthest

vec2 sclera_uv(vec3 direction) {
    float angle = acos(clamp(direction.z, -1.0, 1.0));
    vec2 axis = direction.xy / max(length(direction.xy), 1e-5);
    return 0.5 + 0.5 * axis * min(angle / SCLERA_EDGE, 0.99) * vec2(u_mirror, 1.0);
}

float sclera_lod(sampler2D map) {
    float texel_mm = 2.0 * SCLERA_EDGE * GLOBE_RADIUS_MM / float(textureSize(map, 0).x);
    return max(log2(u_mm_per_px / texel_mm), 0.0);
}

vec3 sclera_albedo(vec3 direction) {
    if (SCLERA < LOW) return u_sclera_mean;
    return textureLod(u_sclera_albedo, sclera_uv(direction), sclera_lod(u_sclera_albedo)).rgb;
}

// The map's normal, turned with the rotation that takes +z to the point's direction.
vec3 sclera_normal(Surface s) {
    if (SCLERA < HIGH) return s.n_eye;
    vec3 c = normalize(s.p_eye);
    vec3 n = 2.0 * textureLod(u_sclera_normal, sclera_uv(c), sclera_lod(u_sclera_normal)).xyz - 1.0;
    float k = 1.0 / (1.0 + max(c.z, -0.9));
    vec3 tx = vec3(1.0 - c.x * c.x * k, -c.x * c.y * k, -c.x);
    vec3 ty = vec3(-c.x * c.y * k, 1.0 - c.y * c.y * k, -c.y);
    return normalize(s.n_eye + (1.0 - s.cornea) * (n.x * u_mirror * tx + n.y * ty));
}

vec3 sclera_radiance(Surface s) {
    vec3 n = sclera_normal(s);
    float cosine = dot(n, turned_to_eye(u_sun_direction));
    vec3 wrapped = max((cosine + SCATTER_WRAP) / ((1.0 + SCATTER_WRAP) * (1.0 + SCATTER_WRAP)), 0.0);
    vec3 sun = u_sun_irradiance * s.sun * wrapped;
    vec3 ambient = ambient_irradiance(turned_to_world(n)) * s.sky;
    return sclera_albedo(normalize(s.p_eye)) * (sun + ambient) / PI;
}
