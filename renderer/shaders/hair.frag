// Provides: one hair, a lock whose hairs lie side by side, or the soft mark at a hair's root.
// Alpha is the share of the pixel that it covers: exact for a straight edge, so the same hair is
// as dark at every distance. LOCK: hairs that a ribbon stands for; MARK: 1 where it is a mark.

in vec3 v_body;
in vec3 v_glint;
in vec4 v_ribbon;     // way across in px, half width in px, place along, thinning number
in float v_shadow;

out vec4 out_radiance;

// The share of a hair's edge that lies before ``at``, seen through a tent two pixels wide. Wherever
// a hair lies, its pixels add up to its width. Through a box they would too, but where hairs touch
// the ground shone through every few pixels, in dashes: from none of it to a quarter.
float edge(float at) {
    float x = clamp(at, -1.0, 1.0);
    return 0.5 + x * (1.0 - 0.5 * abs(x));
}

float softly_covered(float at, float half_px) { return edge(at + half_px) - edge(at - half_px); }

// How much of a pixel around ``at`` lies within ``half_px``: through a box, for locks' many hairs.
float covered(float at, float half_px) {
    return max(min(half_px, at + 0.5) - max(-half_px, at - 0.5), 0.0);
}

// A lock's hairs lie side by side, of different tone; each begins and ends at its own place.
vec2 lock(float at, float half_px, float along, float number) {
    float strands = float(LOCK);
    float across = (0.5 + 0.5 * at / half_px) * strands + 0.4 * sin(5.0 * along + 40.0 * number);
    float hair = floor(across);
    float hair_px = 2.0 * half_px / strands, seen = clamp(hair_px - 0.6, 0.0, 1.0);
    float tone = mix(0.5, fract(hair * 0.6180340 + number * 17.0), seen);
    float end = mix(0.5, fract(hair * 0.7548777 + number * 31.0), seen);
    float fade = smoothstep(0.0, 0.12, along - 0.15 * fract(7.0 * tone));
    fade *= 1.0 - smoothstep(0.25 + 0.4 * end, 0.55 + 0.45 * end, along);
    float thin = 0.48 * fade;
    float one = min(covered((across - hair - 0.5) * hair_px, thin * hair_px), 1.0);
    return vec2(mix(2.0 * thin, one, seen), tone);
}

vec4 mark(float at, float half_px) {
    float x = clamp(at / max(half_px, 0.5), -1.0, 1.0), middle = 1.0 - x * x;
    float fade = v_ribbon.z * (1.0 - v_ribbon.z) * (1.0 - v_ribbon.z);
    return vec4(v_body, 6.75 * v_shadow * middle * middle * fade);
}

vec4 hair(float at, float half_px) {
    float cover = LOCK > 1 ? covered(at, half_px) : softly_covered(at, half_px);
    float alpha = cover * smoothstep(0.0, 0.04, v_ribbon.z);  // it leaves the skin softly
    float x = clamp(at / max(half_px, 0.5), -1.0, 1.0);
    float round_px = clamp(half_px - 0.5, 0.0, 1.0);
    // A cylinder: the glints run along its middle, thinner sides let light through.
    float middle = 1.0 - x * x;
    vec3 radiance = v_body * mix(1.0, 1.25 - 0.375 * middle, round_px) + v_glint * mix(1.0, 1.5 * middle, round_px);
    if (LOCK > 1) {
        vec2 one = lock(at, max(half_px, 1e-3), v_ribbon.z, v_ribbon.w);
        alpha *= one.x;
        radiance *= 0.55 + 0.9 * one.y;
    }
    return vec4(radiance, alpha);
}

void main() {
    out_radiance = MARK == 1 ? mark(v_ribbon.x, v_ribbon.y) : hair(v_ribbon.x, v_ribbon.y);
}
