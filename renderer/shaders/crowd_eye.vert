// Provides: the globes of eyes that share a mesh, each in its own place. World space in millimetres.
//
// MakeHuman's sockets are wider than our globe, and their lids lie on them. So the globe's skin is
// laid over the socket, arc for arc: the iris keeps its size, and the white reaches the lids.

#include "crowd_eyes.glsl"

in vec3 in_position;  // eye space, mm
in vec3 in_normal;

uniform mat4 u_view_matrix;
uniform mat4 u_projection;
uniform int u_first_eye;

out vec3 v_p_eye;
out vec3 v_n_eye;
flat out int v_eye;

const float WHITE_FROM = 0.61;   // radians from the gaze where the globe is white and round
const float WHITE_SHARE = 0.72;

// The point of the globe that stands for one in its light: the white turns away from the viewer as
// slowly as the wider socket does, or its corners would mirror the ground.
vec3 lit_as(vec3 p_eye) {
    float angle = atan(length(p_eye.xy), p_eye.z);
    if (angle < WHITE_FROM) return p_eye;
    angle = WHITE_FROM + WHITE_SHARE * (angle - WHITE_FROM);
    return length(p_eye) * vec3(normalize(p_eye.xy) * sin(angle), cos(angle));
}

// The place over the socket of a point of the globe, in eye space.
vec3 in_socket(vec3 p_eye, float socket_mm) {
    float radius = length(p_eye), around = length(p_eye.xy);
    float angle = atan(around, p_eye.z) * GLOBE_RADIUS_MM / socket_mm;
    vec2 axis = p_eye.xy / max(around, 1e-5);
    vec3 fitted = (socket_mm + radius - GLOBE_RADIUS_MM) * vec3(axis * sin(angle), cos(angle));
    return fitted - vec3(0.0, 0.0, socket_mm - GLOBE_RADIUS_MM);  // fronts meet
}

void main() {
    v_eye = u_first_eye + gl_InstanceID;
    v_p_eye = lit_as(in_position);
    v_n_eye = in_position == v_p_eye ? in_normal : normalize(v_p_eye);
    CrowdEye eye = u_crowd_eyes[v_eye];
    vec4 p_world = eye.eye_to_world * vec4(in_socket(in_position, eye.facts.y), 1.0);
    gl_Position = u_projection * u_view_matrix * p_world;
}
