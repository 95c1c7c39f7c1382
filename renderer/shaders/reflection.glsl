// Provides: the effect "reflection": what the tear film mirrors, and the sun's highlight on it.
// Off, low: none. Medium: Blinn-Phong and a static 128 cube. High: GGX and a static 1024 cube.
// Ultra: GGX, a static 2048 cube and the moving people before it.
// The sclera's own Blinn-Phong highlight belongs to the effect "sclera" and is drawn here.

uniform samplerCube u_static_cube;   // radiance of the surroundings without the sun
uniform samplerCube u_crowd_cube;    // premultiplied radiance and coverage of the moving people

const float CORNEA_ROUGHNESS = 0.085;        // tear film over the cornea
const float CORNEA_EXPONENT = 400.0;         // Blinn-Phong, at medium
const float SCLERA_EXPONENT = 220.0;         // of a plain sclera
const float FILM_EXPONENT = 2400.0;          // of the film between the bumps of its relief
const float PLAIN_BLUR = 0.05;               // radians by which a plain sclera's mirror is blurred

// The tears along the lower lid have a surface of their own (tears.frag).
vec3 tear_normal(Surface s) {
    return REFLECTION < HIGH ? s.n_eye : s.n_film;  // medium: a plain mirror
}

// Walter et al. 2007, eq. 33 and 34 (GGX, height-correlated shadowing), without Fresnel's factor.
// alpha grows by the turn of the surface within a pixel, so that the glint never falls between, by
// half of the sun's own radius, and by the waves that a pixel averages.
float ggx(float NoH, float NoL, float NoV, float variance) {
    float turn = 0.5 * u_mm_per_px / CORNEA_RADIUS_MM;
    float sun = radians(0.5 * SUN_ANGULAR_RADIUS_DEG);
    float a2 = pow(CORNEA_ROUGHNESS, 4.0) + turn * turn + sun * sun + 2.0 * variance;
    float d = NoH * NoH * (a2 - 1.0) + 1.0;
    float v = NoL * sqrt(NoV * NoV * (1.0 - a2) + a2) + NoV * sqrt(NoL * NoL * (1.0 - a2) + a2);
    return a2 / (PI * d * d) * 0.5 / max(v, 1e-4);
}

// Normalised so that it reflects the same energy at any exponent.
float blinn_phong(float NoH, float exponent) {
    return (exponent + 8.0) / (8.0 * PI) * pow(NoH, exponent);
}

// The exponent of a lobe whose slopes vary by more: 1 / (n + 2) is their variance per axis.
float spread(float exponent, float variance) {
    return 1.0 / (1.0 / (exponent + 2.0) + variance) - 2.0;
}

float highlight_on(vec3 n, Surface s, vec3 l, bool is_ggx, float exponent) {
    vec3 h = normalize(l + s.v_eye);
    float NoH = clamp(dot(n, h), 0.0, 1.0), NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, s.v_eye), 0.02, 1.0);
    float lobe = is_ggx ? ggx(NoH, NoL, NoV, s.film_variance) : blinn_phong(NoH, exponent);
    return fresnel(clamp(dot(l, h), 0.0, 1.0)) * lobe * NoL;
}

vec3 sun_highlight(Surface s, vec3 n_tear) {
    vec3 l = turned_to_eye(u_sun_direction), h = normalize(l + s.v_eye);
    float exponent = SCLERA >= HIGH ? spread(FILM_EXPONENT, s.film_variance) : SCLERA_EXPONENT;
    float on_cornea = 0.0, on_sclera = 0.0;
    // Farther than 18 degrees from the mirror's direction every lobe here is below 1e-3.
    if (REFLECTION >= MEDIUM && s.cornea > 0.002 && dot(n_tear, h) > 0.95)
        on_cornea = highlight_on(n_tear, s, l, REFLECTION >= HIGH, CORNEA_EXPONENT);
    if (s.cornea < 0.998 && dot(s.n_film, h) > 0.95)
        on_sclera = highlight_on(s.n_film, s, l, false, exponent);
    return u_sun_irradiance * s.sun * mix(on_sclera, on_cornea, s.cornea);
}

vec3 surroundings(vec3 d_world, float cone) {
    float texel = 0.5 * PI / float(textureSize(u_static_cube, 0).x);
    float lod = max(log2(cone / texel), 0.0);
    vec3 radiance = textureLod(u_static_cube, d_world, lod).rgb;
    if (REFLECTION >= ULTRA) {
        vec4 people = textureLod(u_crowd_cube, d_world, lod);
        radiance = people.rgb + (1.0 - people.a) * radiance;
    }
    return radiance;
}

// The own face is not in the cubes: rays into lids, nose and cheeks meet skin in the shade, and the
// sky above ends in the dark fringe of the lashes.
vec3 mirrored(Surface s, vec3 n) {
    vec3 d = reflect(-s.v_eye, n);
    vec3 d_world = turned_to_world(d);
    float past_face = OWN_FACE == 1 ? smoothstep(-0.15, 0.25, d_world.z) : 1.0;
    vec2 past = past_lids_and_lashes(s.p_eye, d, 0.9);
    vec3 shaded = u_ahead_irradiance * (0.5 / PI);
    float cone = 2.0 * u_mm_per_px / CORNEA_RADIUS_MM + 4.0 * sqrt(s.film_variance);
    if (SCLERA < HIGH || REFLECTION < HIGH) cone += (1.0 - s.cornea) * PLAIN_BLUR;
    vec3 beyond = mix(LASH_REFLECTANCE * shaded, surroundings(d_world, cone), past.y);
    vec3 seen = mix(LID_REFLECTANCE * shaded, beyond, past.x * past_face);
    return fresnel(clamp(dot(n, s.v_eye), 0.0, 1.0)) * seen;
}

vec3 tear_film_radiance(Surface s) {
    vec3 radiance = vec3(0.0), n = tear_normal(s);
    if (REFLECTION >= MEDIUM) radiance += mirrored(s, n);
    if (REFLECTION >= MEDIUM || SCLERA >= HIGH) radiance += sun_highlight(s, n);
    return radiance;
}
