// Provides: the scene's light. Sun (direction, irradiance), ambient light from nine spherical
// harmonics, and the head's sun shadow. World space in millimetres.

uniform vec3 u_sun_direction;      // unit, towards the sun
uniform vec3 u_sun_irradiance;     // on a surface that faces the sun
uniform vec3 u_ambient_sh[9];      // radiance of the surroundings without the sun
uniform vec3 u_ambient_terms[9];   // their irradiance: factors of 1 y z x xy yz zz xz xx-yy
uniform vec3 u_ahead_irradiance;   // on a surface that faces as the head does
uniform sampler2D u_sun_shadow;    // depth seen from the sun, 0 near .. 1 far
uniform mat4 u_world_to_shadow;    // world -> clip space of the shadow map

// Ramamoorthi and Hanrahan 2001, eq. 13: irradiance from the first nine coefficients. Their
// constants are in the terms (renderer/spherical_harmonics.py).
vec3 ambient_irradiance(vec3 n) {
    vec3 x = u_ambient_terms[3] + n.x * u_ambient_terms[8] + n.y * u_ambient_terms[4]
           + n.z * u_ambient_terms[7];
    vec3 y = u_ambient_terms[1] - n.y * u_ambient_terms[8] + n.z * u_ambient_terms[5];
    vec3 z = u_ambient_terms[2] + n.z * u_ambient_terms[6];
    return max(u_ambient_terms[0] + n.x * x + n.y * y + n.z * z, vec3(0.0));
}

// Share of the sun that reaches a point: percentage-closer filtering over 3 x 3 texels, 2 x 2
// bilinear weights by hand so that the result is the same on every GL renderer.
float sun_visibility(vec3 p_world, float bias_mm) {
    vec4 q = u_world_to_shadow * vec4(p_world + u_sun_direction * bias_mm, 1.0);
    vec3 s = q.xyz / q.w * 0.5 + 0.5;
    if (any(lessThan(s, vec3(0.0))) || any(greaterThan(s, vec3(1.0)))) return 1.0;
    vec2 size = vec2(textureSize(u_sun_shadow, 0));
    vec2 texel = s.xy * size - 0.5;
    ivec2 base = ivec2(floor(texel)) - 1;
    vec2 f = fract(texel);
    float lit = 0.0;
    for (int y = 0; y < 4; ++y) for (int x = 0; x < 4; ++x) {
        float wx = x == 0 ? 1.0 - f.x : (x == 3 ? f.x : 1.0);
        float wy = y == 0 ? 1.0 - f.y : (y == 3 ? f.y : 1.0);
        ivec2 at = clamp(base + ivec2(x, y), ivec2(0), ivec2(size) - 1);
        lit += wx * wy * step(s.z, texelFetch(u_sun_shadow, at, 0).r);
    }
    return lit / 9.0;
}
