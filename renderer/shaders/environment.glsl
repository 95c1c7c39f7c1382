// Provides: environment_radiance(d), the park towards a unit direction d without the sun's disc:
// clear sky, clouds, lawn and paths, the painted horizon lit by this sun. World axes; linear
// Rec. 709 radiance. Every lookup chooses its level from u_footprint_rad: no derivatives.

uniform vec3 u_environment_sun;              // unit, towards the sun
uniform vec3 u_environment_sun_irradiance;   // on a surface that faces the sun
uniform vec3 u_environment_sky_irradiance;   // of the clear sky on level ground
uniform vec3 u_perez[5];                     // A to E for Y, x, y
uniform vec2 u_aureole[2];                   // per lobe: radiance per irradiance of the sun, width
uniform vec3 u_zenith;                       // Y, x, y that the Perez function multiplies
uniform sampler2D u_noise;                   // four tiling fields, each uniform in 0..1
uniform sampler2D u_skyline_albedo;          // square root of albedo, coverage
uniform sampler2D u_skyline_shape;           // normal times openness, share of glass
uniform float u_footprint_rad;               // angle between neighbouring texels of the target

const float PI_ENVIRONMENT = 3.14159265359;

// Preetham, Shirley and Smits 1999, eq. 3; XYZ to Rec. 709 as IEC 61966-2-1.
vec3 clear_sky(vec3 d) {
    float cos_theta = max(d.y, 0.01);
    float cos_gamma = clamp(dot(d, u_environment_sun), -1.0, 1.0);
    float gamma = acos(cos_gamma);
    vec3 Yxy = u_zenith * (1.0 + u_perez[0] * exp(u_perez[1] / cos_theta))
             * (1.0 + u_perez[2] * exp(u_perez[3] * gamma) + u_perez[4] * cos_gamma * cos_gamma);
    vec3 XYZ = Yxy.x * vec3(Yxy.y, Yxy.z, 1.0 - Yxy.y - Yxy.z) / Yxy.z;
    vec3 sky = max(mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259,
                        -0.4985314, 0.0415560, 1.0572252) * XYZ, vec3(0.0));
    float haze = u_aureole[0].x * exp(-gamma / u_aureole[0].y)
               + u_aureole[1].x * exp(-gamma / u_aureole[1].y);
    return sky + haze * u_environment_sun_irradiance;
}

float noise_lod(float footprint) { return log2(max(footprint * 512.0, 1.0)); }

// Where the wind has brought the clouds: broken cumulus in the sky that the corneas reflect.
const vec2 CLOUD_DRIFT = vec2(0.25, 0.85);

float cloud_depth(vec2 p, float lod) {
    float shape = 0.66 * textureLod(u_noise, p * 0.19 + CLOUD_DRIFT, lod - 2.4).r
                + 0.24 * textureLod(u_noise, p * 0.53 + 0.4, lod - 0.9).g
                + 0.10 * textureLod(u_noise, p * 1.71, lod + 0.8).g;
    return smoothstep(0.54, 0.80, shape);
}

// Fair-weather clouds on a plane: bright edges towards the sun, greyer where they are deep.
vec3 clouds_over(vec3 sky, vec3 d) {
    float slope = 1.0 / (d.y + 0.10);
    vec2 p = d.xz * slope;
    float lod = noise_lod(u_footprint_rad * slope * slope);
    float depth = cloud_depth(p, lod);
    vec2 sunward = p + normalize(u_environment_sun.xz + 1e-4) * 0.25;
    float towards_sun = smoothstep(0.35, 0.95, textureLod(u_noise, sunward * 0.19 + CLOUD_DRIFT, lod - 2.4).r);
    float facing = max(dot(d, u_environment_sun), 0.0);
    // Thin cloud scatters forwards: its edges near the sun are several times as bright as snow.
    float silver = 1.0 + 8.0 * pow(facing, 6.0) * (1.0 - 0.55 * depth);
    vec3 lit = u_environment_sun_irradiance * mix(1.25, 0.40, towards_sun * depth) * silver;
    vec3 cloud = (lit + 0.8 * u_environment_sky_irradiance) / PI_ENVIRONMENT;
    // No cloud stands before the sun itself: its light is a separate, unshadowed term.
    float share = depth * 0.92 * smoothstep(0.02, 0.16, d.y) * (1.0 - smoothstep(0.972, 0.996, facing));
    return mix(sky, cloud, share);
}

// A path crosses before the face (people walk along it), another leads away from it.
float path_share(vec2 p, float edge) {
    float across = abs(p.y - 1.75 - 0.012 * p.x * p.x) - 1.05;
    float along = max(abs(p.x - 0.9 - 0.22 * p.y) - 0.8, 1.0 - p.y);
    float wobble = 0.25 * (textureLod(u_noise, p * 0.09, 2.0).g - 0.5);
    return 1.0 - smoothstep(-edge, edge, min(across, along) + wobble);
}

vec3 ground(vec3 d) {
    const float eye_height_m = 1.62;
    float away = eye_height_m / max(-d.y, 1e-3);
    vec2 p = d.xz * away;
    float footprint = u_footprint_rad * away * away / eye_height_m;
    float blades = textureLod(u_noise, p * 0.83, noise_lod(footprint * 0.83)).b;
    float patches = textureLod(u_noise, p * 0.021, noise_lod(footprint * 0.021)).r;
    float grain = textureLod(u_noise, p * 1.7, noise_lod(footprint * 1.7)).a;
    vec3 grass = mix(vec3(0.060, 0.108, 0.022), vec3(0.128, 0.160, 0.046), patches)
               * (0.55 + 0.9 * blades);
    vec3 gravel = vec3(0.33, 0.29, 0.23) * (0.55 + 0.6 * grain + 0.3 * patches);
    vec3 albedo = mix(grass, gravel, path_share(p, 0.02 + footprint));
    // The shade of the trees around the lawn, dappled.
    float shade = smoothstep(12.0, 34.0, away) * smoothstep(0.42, 0.62,
        textureLod(u_noise, p * 0.035 + 0.3, noise_lod(footprint * 0.035)).g);
    vec3 sun = u_environment_sun_irradiance * max(u_environment_sun.y, 0.0) * (1.0 - 0.72 * shade);
    vec3 lit = albedo * (sun + u_environment_sky_irradiance) / PI_ENVIRONMENT;
    if (away < 60.0) return lit;
    vec3 haze = clear_sky(normalize(vec3(d.x, 0.03, d.z))) * 0.75;
    return mix(lit, haze, 1.0 - exp((60.0 - away) / 700.0));
}

vec4 skyline(vec3 d) {
    // The panorama: azimuth -180..180 over 4096 columns, elevation from -6 degrees over 640 rows.
    vec2 uv = vec2(atan(d.x, d.z) / (2.0 * PI_ENVIRONMENT) + 0.5,
                   (degrees(asin(clamp(d.y, -1.0, 1.0))) + 6.0) / (640.0 * 360.0 / 4096.0));
    if (uv.y <= 0.0 || uv.y >= 1.0) return vec4(0.0);
    float lod = log2(max(u_footprint_rad * 4096.0 / (2.0 * PI_ENVIRONMENT), 1.0));
    vec4 albedo = textureLod(u_skyline_albedo, uv, lod);
    if (albedo.a < 0.004) return vec4(0.0);
    vec4 shape = textureLod(u_skyline_shape, uv, lod);
    vec3 bent = (shape.xyz * 2.0 - 1.0) / albedo.a;
    float openness = clamp(length(bent), 0.05, 1.0);
    vec3 n = normalize(bent + vec3(0.0, 1e-4, 0.0));
    vec3 colour = albedo.rgb / albedo.a;
    float facing = dot(n, u_environment_sun);
    // Leaves pass light: what the sun gives the far side shows through, yellower.
    bool is_leaf = colour.g > 1.08 * colour.r;
    float sun = max(0.82 * facing + 0.18, 0.0) * mix(0.45, 1.0, openness);
    vec3 through = is_leaf ? vec3(0.55, 0.48, 0.16) * max(-facing + 0.35, 0.0) : vec3(0.0);
    vec3 irradiance = u_environment_sun_irradiance * (sun + through)
                    + u_environment_sky_irradiance * openness * (0.62 + 0.38 * n.y);
    vec3 radiance = colour * colour * irradiance / PI_ENVIRONMENT;
    float glass = shape.a / albedo.a;
    if (glass > 0.01) {
        vec3 r = reflect(d, n);
        float glint = 40.0 * pow(max(dot(normalize(vec3(r.x, max(r.y, 0.02), r.z)),
                                         u_environment_sun), 0.0), 60.0);
        radiance += glass * (0.22 * clear_sky(vec3(r.x, abs(r.y) + 0.05, r.z))
                             + 0.1 * glint * u_environment_sun_irradiance);
    }
    return vec4(radiance, 1.0) * albedo.a;
}

vec3 environment_radiance(vec3 d) {
    vec3 radiance = d.y > 0.0 ? clouds_over(clear_sky(d), d) : ground(d);
    vec4 horizon = skyline(d);
    return min(radiance * (1.0 - horizon.a) + horizon.rgb, vec3(6.0e4));
}
