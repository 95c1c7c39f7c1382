// Provides: a picture as it is, pixel by pixel.

uniform sampler2D u_picture;

out vec4 o_radiance;

void main() { o_radiance = texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0); }
