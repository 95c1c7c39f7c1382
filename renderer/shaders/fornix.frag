// Provides: the fold behind the globe: tissue in even shade.

uniform vec3 u_radiance;

out vec4 f_radiance;

void main() { f_radiance = vec4(u_radiance, 1.0); }
