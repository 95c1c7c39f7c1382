// Provides: single scattering through the iris's layers alone, for certification: every pixel is a
// point of the maps, view and light come from one direction each.

#include "surface.glsl"
#include "refraction.glsl"
#include "texture.glsl"

struct IrisLight { vec3 w_eye; };  // all that the layers ask of caustics.glsl's

#include "subsurface.glsl"

uniform vec2 u_probe_origin_mm;  // of the lower left pixel's centre on the maps
uniform float u_probe_step_mm;
uniform vec3 u_probe_view;       // unit, travelling into the iris
uniform vec3 u_probe_light;

out vec4 f_radiance;

void main() {
    IrisTexel texel;
    texel.map_mm = u_probe_origin_mm + floor(gl_FragCoord.xy) * u_probe_step_mm;
    ViewRay ray;
    ray.d_eye = u_probe_view;
    IrisLight light;
    light.w_eye = u_probe_light;
    f_radiance = vec4(single_scattering(texel, ray, light), 1.0);
}
