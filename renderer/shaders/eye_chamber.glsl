// Provides: sun and sky inside one eye's chamber, from maps of the clip (renderer/eye/caustics.py,
// chamber.py). crowd_chamber.glsl says the same of many eyes. Needs texture.glsl, relief.glsl.

uniform sampler2D u_caustic_map;   // light's direction x, y; gain of irradiance
uniform sampler2D u_chamber_map;   // irradiance of the surroundings
uniform sampler2D u_relief_shade;  // of the sun by the iris's relief, over SHADE_RANGE

vec3 caustic_at(vec2 x_mm) {
    return textureLod(u_caustic_map, plane_uv(x_mm), plane_lod(u_caustic_map)).xyz;
}

vec3 chamber_at(vec2 x_mm) { return textureLod(u_chamber_map, plane_uv(x_mm), 0.0).rgb; }

float relief_shade_at(vec2 x_mm) {
    return SHADE_RANGE * textureLod(u_relief_shade, plane_uv(x_mm), plane_lod(u_relief_shade)).r;
}
