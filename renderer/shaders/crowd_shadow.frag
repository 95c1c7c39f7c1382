// Provides: a shadow as premultiplied coverage: it takes the sun's share of the ground's light.

uniform float u_shade;   // share of the ground's light that the sun gives

out vec4 o_radiance;

void main() { o_radiance = vec4(0.0, 0.0, 0.0, u_shade); }
