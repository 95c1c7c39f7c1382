// Provides: the scene's light. Sun (direction, irradiance), ambient light from nine spherical
// harmonics, and the head's sun shadow. World space in millimetres.

uniform vec3 u_sun_direction;      // unit, towards the sun
uniform vec3 u_sun_irradiance;     // on a surface that faces the sun
uniform vec3 u_ambient_sh[9];      // radiance of the surroundings without the sun
uniform sampler2D u_sun_shadow;    // depth seen from the sun, 0 near .. 1 far
uniform mat4 u_world_to_shadow;    // world -> clip space of the shadow map

// Ramamoorthi and Hanrahan 2001, eq. 13: irradiance from the first nine coefficients.
vec3 ambient_irradiance(vec3 n) {
    const float c1 = 0.429043, c2 = 0.511664, c3 = 0.743125, c4 = 0.886227, c5 = 0.247708;
    vec3 e = c1 * u_ambient_sh[8] * (n.x * n.x - n.y * n.y) + c3 * u_ambient_sh[6] * n.z * n.z
           + c4 * u_ambient_sh[0] - c5 * u_ambient_sh[6]
           + 2.0 * c1 * (u_ambient_sh[4] * n.x * n.y + u_ambient_sh[7] * n.x * n.z
                         + u_ambient_sh[5] * n.y * n.z)
           + 2.0 * c2 * (u_ambient_sh[3] * n.x + u_ambient_sh[1] * n.y + u_ambient_sh[2] * n.z);
    return max(e, vec3(0.0));
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
