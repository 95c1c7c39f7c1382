// Provides: the mark of a bystander's part, for outlines.

flat in float v_mark;

out vec4 f_mark;

void main() { f_mark = vec4(v_mark / 255.0); }
