// Provides: the mark of what is drawn, for outlines.

uniform float u_mark;   // 1/255 of it

out vec4 f_mark;

void main() { f_mark = vec4(u_mark); }
