// Provides: the effect "texture": what the iris is like at a point of its plane.
// Off: one mean colour. Low to ultra: the iris map at the level's size; from high on its relief
// counts too (relief.glsl).

uniform sampler2D u_iris_albedo;   // rgb reflectance, a openness of cavities
uniform sampler2D u_iris_normal;   // of the relief, packed to 0..1
uniform vec3 u_iris_mean;          // mean reflectance of the iris
uniform float u_pupil_mm;          // diameter
uniform vec3 u_iris_gain;          // of the preset: thesis or calibrated

const float MAP_EDGE_MM = 6.0;     // half the side of every map of the iris plane
const vec3 LIMBAL_TISSUE = vec3(0.085, 0.07, 0.06);  // share of the light on the limbus
const float MAGNIFICATION = 1.12;  // the cornea's

struct IrisTexel {
    vec3 albedo;
    float cavity;    // 1 open .. 0 deep in a crypt
    vec2 map_mm;     // the point on the maps, whose pupil is canonical
};

// The tissue stretches evenly between the pupil's edge and the root (Pamplona et al. 2009): mm of
// the maps per mm of the iris along its radius.
float tissue_stretch() {
    return (IRIS_MAP_RADIUS_MM - MAP_PUPIL_RADIUS_MM) / (IRIS_MAP_RADIUS_MM - 0.5 * u_pupil_mm);
}

vec2 map_point(vec2 x_mm) {
    float r = min(length(x_mm), IRIS_MAP_RADIUS_MM), pupil = 0.5 * u_pupil_mm;
    float mapped = r < pupil ? r * MAP_PUPIL_RADIUS_MM / pupil
                             : MAP_PUPIL_RADIUS_MM + (r - pupil) * tissue_stretch();
    return x_mm * (mapped / max(length(x_mm), 1e-4)) * vec2(u_mirror, 1.0);
}

vec2 plane_uv(vec2 x_mm) { return 0.5 + 0.5 * x_mm / MAP_EDGE_MM; }

// Explicit level of detail: bent rays have discontinuous derivatives at the limbus.
float plane_lod(sampler2D map) {
    float texel_mm = 2.0 * MAP_EDGE_MM / float(textureSize(map, 0).x);
    return max(log2(u_mm_per_px / (MAGNIFICATION * texel_mm)), 0.0);
}

// What lies behind the pupil's edge is dark.
float outside_pupil(float r) {
    float pupil = 0.5 * u_pupil_mm, soft = max(u_mm_per_px, 0.06);
    return smoothstep(pupil - 0.5 * soft, pupil + 0.5 * soft, r);
}

// Beyond the iris's root the ray meets the limbus from inside: dark tissue that glows a little with
// the light that seeps through it. Maps are never read there.
float beyond_root(float r) {
    return smoothstep(IRIS_MAP_RADIUS_MM - 0.35, IRIS_MAP_RADIUS_MM + 0.35, r);
}

// Relief that is pushed together along the radius grows steeper there: furrows deepen as the pupil
// widens.
vec3 stretched(vec3 n, vec2 x_mm) {
    vec2 axis = x_mm / max(length(x_mm), 1e-4);
    n.xy += (tissue_stretch() - 1.0) * dot(n.xy, axis) * axis;
    return normalize(n);
}

IrisTexel iris_texel(vec2 x_mm) {
    IrisTexel texel;
    float r = length(x_mm);
    texel.map_mm = map_point(x_mm);
    texel.albedo = u_iris_mean;
    texel.cavity = 1.0;
    if (TEXTURE >= LOW) {
        vec4 map = textureLod(u_iris_albedo, plane_uv(texel.map_mm), plane_lod(u_iris_albedo));
        texel.albedo = map.rgb;
        texel.cavity = map.a;
    }
    texel.albedo *= outside_pupil(r);
    return texel;
}
