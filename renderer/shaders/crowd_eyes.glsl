// Provides: where the eyes of the crowd are, one record each (renderer/crowd/eyes.py).

const int MOST_EYES = 64;

struct CrowdEye {
    mat4 eye_to_world;   // without scale; z is the gaze
    vec4 facts;          // u_mirror, socket's radius in mm, share of sun and of sky past the head
    vec4 lids;           // row of the rims' table; by how many mm the gaze is turned right and up
};

layout(std140) uniform CrowdEyes { CrowdEye u_crowd_eyes[MOST_EYES]; };
