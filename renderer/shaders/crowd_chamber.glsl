// Provides: what eye_chamber.glsl does, for eyes that are drawn together: caustics from one pool for
// every direction of the sun, the sky as an even one, relief shaded in place.

uniform sampler2DArray u_caustic_pool;  // sun in the plane of x and z, a layer per CAUSTIC_STEP_DEG

const float EVEN_SKY = 0.93;  // what a flat interface keeps of an even sky's light

// The cornea is round about the gaze: turning the sun about it turns the caustic.
vec3 caustic_at(vec2 x_mm) {
    vec3 toward_sun = turned_to_eye(u_sun_direction);
    vec2 axis = toward_sun.xy / max(length(toward_sun.xy), 1e-5);
    vec2 side = vec2(-axis.y, axis.x);
    vec2 uv = plane_uv(vec2(dot(x_mm, axis), dot(x_mm, side)));
    float last = float(textureSize(u_caustic_pool, 0).z - 1);
    float layer = min(degrees(acos(clamp(toward_sun.z, -1.0, 1.0))) / CAUSTIC_STEP_DEG, last);
    float texel_mm = 2.0 * MAP_EDGE_MM / float(textureSize(u_caustic_pool, 0).x);
    float lod = max(log2(u_mm_per_px / (MAGNIFICATION * texel_mm)), 0.0);
    vec3 before = textureLod(u_caustic_pool, vec3(uv, floor(layer)), lod).xyz;
    vec3 after = textureLod(u_caustic_pool, vec3(uv, min(floor(layer) + 1.0, last)), lod).xyz;
    vec3 found = mix(before, after, fract(layer));
    return vec3(found.x * axis + found.y * side, found.z);
}

vec3 chamber_at(vec2 x_mm) {
    return EVEN_SKY * CORNEA_IOR * CORNEA_IOR * plane_irradiance() * shade_at(vec3(x_mm, APEX_MM)).rgb;
}

vec3 light_direction(vec2 x_mm);

float relief_shade_at(vec2 x_mm) { return relief_shading(x_mm, light_direction(x_mm)); }
