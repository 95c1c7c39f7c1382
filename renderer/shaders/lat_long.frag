// Provides: a cube map's surroundings as a latitude-longitude picture. The first row is the zenith,
// the middle column looks along +z, columns left of it towards +x (the OpenEXR library's layout).

uniform samplerCube u_cube;
uniform vec2 u_picture_size;

out vec4 o_radiance;

void main() {
    const float pi = 3.14159265359;
    vec2 uv = gl_FragCoord.xy / u_picture_size;
    float azimuth = (0.5 - uv.x) * 2.0 * pi, elevation = (0.5 - uv.y) * pi;
    vec3 d = vec3(sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation));
    o_radiance = vec4(textureLod(u_cube, d, 0.0).rgb, 1.0);
}
