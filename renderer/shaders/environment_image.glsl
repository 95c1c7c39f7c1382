// Provides: environment_radiance(d), a user's picture towards a unit direction d. World axes; linear
// Rec. 709 radiance. The level is chosen from u_footprint_rad: no derivatives.

uniform sampler2D u_environment_image;   // latitude-longitude, row 0 the zenith, middle +z, left +x
uniform float u_environment_turn_rad;    // turns the picture to the viewer's right
uniform float u_footprint_rad;           // angle between neighbouring texels of the target

const float PI_ENVIRONMENT = 3.14159265359;

vec3 environment_radiance(vec3 d) {
    float azimuth = atan(d.x, d.z) - u_environment_turn_rad;
    vec2 uv = vec2(0.5 - azimuth / (2.0 * PI_ENVIRONMENT), acos(clamp(d.y, -1.0, 1.0)) / PI_ENVIRONMENT);
    float texel_rad = 2.0 * PI_ENVIRONMENT / float(textureSize(u_environment_image, 0).x);
    float lod = max(log2(u_footprint_rad / texel_rad), 0.0);
    return textureLod(u_environment_image, uv, lod).rgb;
}
