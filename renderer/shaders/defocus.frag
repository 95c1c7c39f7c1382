// Provides: a panorama of the surroundings as a lens out of focus sees it: every point spread over
// a disc, the sun included. The disc is sampled in a sunflower pattern.

uniform samplerCube u_cube;
uniform vec2 u_panorama_size;
uniform float u_radius_rad;     // of the circle of confusion
uniform int u_points;
uniform float u_lod;            // cube level whose texels are about as far apart as the points
uniform vec3 u_sun_towards;
uniform vec3 u_sun_radiance;    // of the sun spread over the disc

out vec4 o_radiance;

void main() {
    const float pi = 3.14159265359, golden_angle = 2.39996323;
    vec2 uv = gl_FragCoord.xy / u_panorama_size;
    float azimuth = (uv.x - 0.5) * 2.0 * pi, elevation = (uv.y - 0.5) * pi;
    vec3 d = vec3(sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation));
    vec3 right = vec3(cos(azimuth), 0.0, -sin(azimuth)), up = cross(d, right);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < u_points; ++i) {
        float r = u_radius_rad * sqrt((float(i) + 0.5) / float(u_points)), turn = float(i) * golden_angle;
        // A catch of light may glow, not glare: people are to look at the eyes.
        sum += min(textureLod(u_cube, d + r * (cos(turn) * right + sin(turn) * up), u_lod).rgb,
                   vec3(6.0));
    }
    float off = acos(clamp(dot(d, u_sun_towards), -1.0, 1.0)) / u_radius_rad;
    o_radiance = vec4(sum / float(u_points) + u_sun_radiance * (1.0 - smoothstep(0.92, 1.04, off)), 1.0);
}
