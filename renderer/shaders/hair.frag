// Provides: one hair, or a lock of scalp hair, whose strands of different lightness lie side by side.

in vec3 v_radiance;
in vec3 v_hair;       // side, number, alpha

out vec4 out_radiance;

void main() {
    float strand = fract(floor(v_hair.x * 3.0 + 4.0) * 0.618 + v_hair.y * 17.0);
    out_radiance = vec4(v_radiance * (0.6 + 0.8 * strand), v_hair.z);
}
