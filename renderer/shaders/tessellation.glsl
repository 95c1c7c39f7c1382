// Provides: the effect "tessellation": where the surface is and which normal it has.
// Off, low, medium: what the mesh brings (facets or vertex normals). High, ultra: the mesh draws the
// silhouette only; under it the view ray meets the surface's formula, so that no facet is bent light.

const float NEVER = 1e9;

// First meeting with the scleral sphere; grazing rays that miss it touch it.
float sphere_hit(vec3 o, vec3 d) {
    float b = dot(o, d), c = dot(o, o) - GLOBE_RADIUS_MM * GLOBE_RADIUS_MM;
    return -b - sqrt(max(b * b - c, 0.0));
}

// First meeting with Baker's cornea within the part that stands out of the sphere.
float cornea_hit(vec3 o, vec3 d) {
    const float R = CORNEA_RADIUS_MM, p = CORNEA_ASPHERICITY;
    float depth = APEX_MM - o.z;
    float a = p * d.z * d.z + dot(d.xy, d.xy);
    float b = -p * depth * d.z + R * d.z + dot(o.xy, d.xy);
    float c = p * depth * depth - 2.0 * R * depth + dot(o.xy, o.xy);
    float t = (-b - sqrt(max(b * b - a * c, 0.0))) / a;
    vec3 hit = o + t * d;
    bool is_cornea = b * b > a * c && hit.z > 0.0 && length(hit.xy) < LIMBUS_RADIUS_MM + 0.4;
    return is_cornea ? t : NEVER;
}

// Newton's steps from the nearer of both to their smooth join.
vec3 ray_hit(vec3 o, vec3 d) {
    float t = min(sphere_hit(o, d), cornea_hit(o, d));
    for (int i = 0; i < 2; ++i) {
        vec3 p = o + t * d;
        float r = length(p.xy), height, slope;
        if (p.z <= 0.0 || r >= PROFILE_END_MM) continue;
        front_profile(r, height, slope);
        float rate = d.z - slope * dot(p.xy, d.xy) / max(r, 1e-4);
        t -= clamp((p.z - height) / min(rate, -0.1), -0.3, 0.3);
    }
    return o + t * d;
}

vec3 formula_normal(vec3 p_eye) {
    float r = length(p_eye.xy), height, slope;
    if (p_eye.z <= 0.0 || r >= PROFILE_END_MM) return normalize(p_eye);
    front_profile(r, height, slope);
    return normalize(vec3(-slope * p_eye.xy / max(r, 1e-5), 1.0));
}

Surface surface_at(vec3 p_mesh, vec3 n_mesh) {
    Surface s;
    vec3 camera_eye = turned_to_eye(u_camera_mm - u_eye_to_world[3].xyz);
    s.p_eye = p_mesh;
    s.n_eye = normalize(n_mesh);
    if (TESSELLATION >= HIGH) {
        s.p_eye = ray_hit(camera_eye, normalize(p_mesh - camera_eye));
        s.n_eye = formula_normal(s.p_eye);
    }
    s.v_eye = normalize(camera_eye - s.p_eye);
    s.albedo = vec3(0.0);
    s.n_tissue = s.n_film = s.n_eye;
    s.film_variance = 0.0;
    s.cornea = cornea_share(s.p_eye);
    vec4 shade = shade_at(s.p_eye);
    s.sun = shade.a;
    s.sky = shade.rgb;
    return s;
}
