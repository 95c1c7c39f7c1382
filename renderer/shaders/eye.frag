// Provides: one eye's radiance in one pass, all seven effects, linear Rec. 709.
// README.md says how light travels through the files included here.

#include "light.glsl"
#include "surface.glsl"
#include "lids.glsl"
#include "tessellation.glsl"
#include "refraction.glsl"
#include "texture.glsl"
#include "relief.glsl"
#include "caustics.glsl"
#include "subsurface.glsl"
#include "tear_film.glsl"
#include "sclera.glsl"
#include "reflection.glsl"

in vec3 v_p_eye;
in vec3 v_n_eye;

out vec4 f_radiance;

vec3 iris_radiance(Surface s) {
    ViewRay ray = view_through_cornea(s);
    if (TEXTURE >= HIGH && relief_share() > 0.0) ray.x_mm = on_relief(ray.x_mm, ray.d_eye);
    IrisTexel texel = iris_texel(ray.x_mm);
    IrisLight light = light_on_iris(ray.x_mm, s);
    vec3 reflectance = iris_reflectance(texel, ray, light);
    vec3 sun = light.sun * relief_shade(ray.x_mm);
    vec3 ambient = light.ambient * texel.cavity;
    vec3 iris = u_iris_gain * (reflectance * (sun + ambient) + u_iris_mean * light.painted) / PI;
    return ray.transmitted * mix(iris, limbal_radiance(s), beyond_root(length(ray.x_mm)));
}

vec3 eye_radiance(Surface s) {
    s = with_waves(s);
    vec3 body = vec3(0.0);
    // Not loops of none or one turn, which once saved software GL a side that no pixel takes: it keeps
    // in memory what loops compute, and takes half as long again.
    bool is_sclera = s.cornea < 0.998;
    if (s.cornea > 0.002) body += s.cornea * iris_radiance(s);
    if (is_sclera) {
        s = on_sclera(s);
        body += (1.0 - s.cornea) * sclera_radiance(s);
    }
    return min(body * limbal_ring(s) + tear_film_radiance(s), vec3(6e4));
}

void main() {
    place_eye();
    vec3 radiance = vec3(0.0);
    if (between_lids(v_p_eye)) radiance = eye_radiance(surface_at(v_p_eye, v_n_eye));
    f_radiance = vec4(radiance, 2.0);
}
