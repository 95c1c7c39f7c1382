// Provides: what the iris's relief makes of the sun's light, once per clip: a map of the iris plane.

#include "light.glsl"
#include "surface.glsl"
#include "texture.glsl"
#include "relief.glsl"
#include "caustics.glsl"

uniform int u_map_px;

out float f_shade;

void main() {
    vec2 x_mm = (gl_FragCoord.xy / float(u_map_px) * 2.0 - 1.0) * MAP_EDGE_MM;
    f_shade = relief_shading(x_mm, light_direction(x_mm)) / SHADE_RANGE;
}
