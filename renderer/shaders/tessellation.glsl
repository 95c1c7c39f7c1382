// Provides: the effect "tessellation": which normal a point of the mesh has.
// Off, low, medium: what the mesh brings (facets or vertex normals). High, ultra: the mesh only
// places the silhouette; position and normal come from the surface's formula.

Surface surface_at(vec3 p_mesh, vec3 n_mesh) {
    Surface s;
    s.p_eye = p_mesh;
    s.n_eye = normalize(n_mesh);
    if (TESSELLATION >= HIGH) {
        float r = length(p_mesh.xy);
        if (p_mesh.z > 0.0 && r < PROFILE_END_MM) {
            float slope;
            front_profile(r, s.p_eye.z, slope);
            s.n_eye = normalize(vec3(-slope * p_mesh.xy / max(r, 1e-5), 1.0));
        } else {
            s.n_eye = normalize(p_mesh);
            s.p_eye = GLOBE_RADIUS_MM * s.n_eye;
        }
    }
    s.v_eye = normalize(turned_to_eye(u_camera_mm - world_from_eye(s.p_eye)));
    s.cornea = cornea_share(s.p_eye);
    s.sun = sun_reaching(s.p_eye, turned_to_eye(u_sun_direction));
    return s;
}
