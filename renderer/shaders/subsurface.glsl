// Provides: the effect "subsurface": the iris's reflectance through its layers.
// Off, low, medium: the map's reflectance (Lambert). High, ultra: single scattering along the bent
// view ray, lit from the bent light's direction, on a floor of multiple scattering.
// renderer/eye/subsurface.py is the reference.

uniform sampler2D u_thickness;         // of the four layers, mm
uniform mat4x3 u_sigma_s;              // per layer, mm^-1
uniform mat4x3 u_sigma_t;
uniform vec4 u_anisotropy;
uniform vec3 u_subsurface_gain;        // makes the mean column's single scattering white
uniform float u_multiple_share;        // of the reflectance, left to multiple scattering

// Of the light that enters the layers, a share leaves them nowhere near: aside under the limbus, or
// into the pigment epithelium. The preset "calibrated" gives it back.
const float LAYERS_RETURN = 0.86;

// Henyey and Greenstein 1941.
vec4 phase(float cosine) {
    vec4 g = u_anisotropy, base = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}

vec4 interfaces(vec4 thickness) {
    vec4 e = thickness;
    e.y += e.x; e.z += e.y; e.w += e.z;
    return e;
}

vec4 thickness_at(vec2 map_mm, float lod) {
    return textureLod(u_thickness, plane_uv(map_mm), lod);
}

// One-hot layer of a point: the first whose lower interface lies below it (room > 0).
vec4 layer_of(vec4 room) {
    vec4 below = vec4(greaterThan(room, vec4(0.0)));
    return below - vec4(0.0, below.xyz);
}

vec3 light_depth(vec4 thickness, float depth, float light_cosine) {
    vec4 tops = interfaces(thickness) - thickness;
    return u_sigma_t * clamp(depth - tops, vec4(0.0), thickness) / light_cosine;
}

// Mean of exp(-tau) while tau grows by change and exp(-tau) falls from start to end.
vec3 mean_transmittance(vec3 start, vec3 end, vec3 change) {
    return mix((start - end) / max(change, vec3(1e-3)), start, lessThan(change, vec3(1e-3)));
}

// The nearest interface beyond the fraction a of an interval, or its end.
float next_cut(vec4 cut, float a) {
    vec4 beyond = mix(vec4(1.0), cut, greaterThan(cut, vec4(a + 1e-5)));
    return min(min(beyond.x, beyond.y), min(beyond.z, beyond.w));
}

struct March {
    vec2 map_mm;         // start on the maps
    vec2 drift;          // along the plane per mm of ray
    float view_cosine;
    float light_cosine;
    float length_mm;
    float lod;
    vec4 phase;
};

// Interfaces linear between nodes, extinction exact in each piece (ours).
vec3 march_pieces(March m) {
    float stride = m.length_mm / float(SUBSURFACE_NODES);
    vec3 radiance = vec3(0.0), to_viewer = vec3(0.0), tau = vec3(0.0), left = vec3(1.0);
    vec4 t0 = thickness_at(m.map_mm, m.lod);
    float z0 = 0.0;
    for (int i = 1; i <= SUBSURFACE_NODES; ++i) {
        vec4 t1 = thickness_at(m.map_mm + m.drift * stride * float(i), m.lod);
        float z1 = stride * float(i) * m.view_cosine;
        vec4 room0 = interfaces(t0) - z0, room1 = interfaces(t1) - z1;
        vec4 cut = mix(vec4(1.0), room0 / (room0 - room1), lessThan(room0 * room1, vec4(0.0)));
        float a = 0.0;
        while (a < 0.99999) {  // nearly always once
            float b = next_cut(cut, a);
            vec4 layer = layer_of(mix(room0, room1, 0.5 * (a + b)));
            float span = (b - a) * stride;
            to_viewer += u_sigma_t * layer * span;
            vec3 end = to_viewer + light_depth(mix(t0, t1, b), mix(z0, z1, b), m.light_cosine);
            vec3 left_end = exp(-end);
            radiance += u_sigma_s * (layer * m.phase) * span
                      * mean_transmittance(left, left_end, end - tau);
            tau = end;
            left = left_end;
            a = b;
        }
        t0 = t1;
        z0 = z1;
    }
    return radiance / m.light_cosine;
}

// Thesis section 4.5: a sum over the left ends of equal steps.
vec3 march_left_sum(March m) {
    float stride = m.length_mm / float(SUBSURFACE_SAMPLES);
    vec3 radiance = vec3(0.0), to_viewer = vec3(0.0);
    for (int i = 0; i < SUBSURFACE_SAMPLES; ++i) {
        vec4 t = thickness_at(m.map_mm + m.drift * stride * float(i), m.lod);
        float z = stride * float(i) * m.view_cosine;
        vec4 layer = layer_of(interfaces(t) - z);
        vec3 tau = to_viewer + light_depth(t, z, m.light_cosine);
        radiance += u_sigma_s * (layer * m.phase) * stride * exp(-tau);
        to_viewer += u_sigma_t * layer * stride;
    }
    return radiance / m.light_cosine;
}

vec3 single_scattering(IrisTexel texel, ViewRay ray, IrisLight light) {
    March m;
    m.lod = plane_lod(u_thickness);
    m.map_mm = texel.map_mm;
    m.view_cosine = max(-ray.d_eye.z, 0.25);
    m.drift = ray.d_eye.xy * vec2(u_mirror, 1.0);
    m.light_cosine = max(-light.w_eye.z, MIN_LIGHT_COSINE);
    float column = dot(thickness_at(m.map_mm, m.lod), vec4(1.0));
    m.length_mm = min(MAX_DEPTH_MM, DEPTH_MARGIN * column) / m.view_cosine;
    m.phase = phase(dot(light.w_eye, -ray.d_eye));
    if (SUBSURFACE_LEFT_SUM == 1) return march_left_sum(m);
    return march_pieces(m);
}

// Share of the map's reflectance that this path through the layers returns. The same march stands
// for the sky's light too, as if it came from the sun's direction.
vec3 iris_reflectance(IrisTexel texel, ViewRay ray, IrisLight light) {
    if (SUBSURFACE < HIGH) return texel.albedo;
    vec3 single = PI * u_subsurface_gain * single_scattering(texel, ray, light);
    return LAYERS_RETURN * texel.albedo * mix(single, vec3(1.0), u_multiple_share);
}
