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

// A slope on the map, turned with the rotation that takes +z to the point's direction.
vec3 turned_slope(vec2 slope, vec3 c) {
    float k = dot(c.xy, slope) / (1.0 + max(c.z, -0.9));
    return vec3(slope - k * c.xy, -dot(c.xy, slope));
}

// What the maps say of a point of the white: colour, tissue's normal, the film's normal over it.
Surface on_sclera(Surface s) {
    vec3 c = normalize(s.p_eye);
    vec2 uv = sclera_uv(c), mirror = vec2(u_mirror, 1.0);
    s.albedo = u_sclera_mean;
    if (SCLERA >= LOW)
        s.albedo = textureLod(u_sclera_albedo, uv, sclera_lod(u_sclera_albedo)).rgb;
    if (SCLERA >= HIGH) {
        float white = 1.0 - s.cornea;
        vec2 n = 2.0 * textureLod(u_sclera_normal, uv, sclera_lod(u_sclera_normal)).xy - 1.0;
        s.n_tissue = normalize(s.n_eye + white * turned_slope(n * mirror, c));
        vec4 tile = relief_tile((2.0 * uv - 1.0) * SCLERA_HALF_SIZE_MM);
        // At a slant near folds hide the steep sides of those behind.
        float shown = clamp(2.0 * dot(s.n_eye, s.v_eye), 0.0, 1.0);
        tile.xyz *= vec3(shown, shown, shown * shown);
        s.n_film = normalize(mix(s.n_tissue, s.n_film, s.cornea)
                             + white * turned_slope(tile.xy * mirror, c));
        s.film_variance = mix(tile.z, s.film_variance, s.cornea);
    }
    return s;
}

vec3 sclera_radiance(Surface s) {
    vec3 n = s.n_tissue;
    float cosine = dot(n, turned_to_eye(u_sun_direction));
    vec3 wrapped = max((cosine + SCATTER_WRAP) / ((1.0 + SCATTER_WRAP) * (1.0 + SCATTER_WRAP)), 0.0);
    vec3 sun = u_sun_irradiance * scattered_sun_at(s.p_eye) * wrapped;
    vec3 ambient = ambient_irradiance(turned_to_world(n)) * s.sky;
    // The map shows the tissue face-on through the tear film: at a slant the film mirrors more, and
    // lets that much less of the tissue's light through.
    float film = 1.0;
    if (REFLECTION >= MEDIUM)
        film = (1.0 - fresnel(clamp(dot(s.n_eye, s.v_eye), 0.0, 1.0))) / (1.0 - fresnel(1.0));
    return film * s.albedo * (sun + ambient) / PI;
}
