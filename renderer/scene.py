"""What stands in the scene: surroundings, main character, crowd, and the light they share."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from renderer.clip import ClipSpec
from renderer.crowd.crowd import Crowd
from renderer.head.head import Head
from renderer.head.sun_shadow import build_light
from renderer.light import Light
from renderer.park.surroundings import Surroundings

SceneKey = tuple[object, ...]


@dataclass
class Scene:
    """Everything but the eyes; clips that differ in their eyes or camera alone share it."""

    key: SceneKey
    surroundings: Surroundings
    head: Head
    light: Light
    crowd: Crowd


def scene_key(spec: ClipSpec) -> SceneKey:
    """Return what a scene depends on."""
    return (
        spec.environment,
        spec.environment_sha256,
        spec.environment_turn_deg,
        spec.environment_exposure_ev,
        spec.sun_azimuth_deg,
        spec.sun_elevation_deg,
        spec.gaze_yaw_deg,
        spec.gaze_pitch_deg,
        spec.vergence_deg,
        spec.blink,
        spec.crowd,
    )


def build_scene(gl: moderngl.Context, spec: ClipSpec) -> Scene:
    """Build the scene of a clip."""
    surroundings = Surroundings(gl, spec)
    head = Head(gl, spec)
    light = build_light(gl, surroundings.sky, head)
    crowd = Crowd(gl, spec, light)
    return Scene(scene_key(spec), surroundings, head, light, crowd)
