"""What stands in the scene: surroundings, main character, crowd, and the light they share."""

from __future__ import annotations

from dataclasses import dataclass, field

import moderngl

from renderer.clip import ClipSpec
from renderer.crowd.crowd import PAINTED_CROWD, Crowd
from renderer.crowd.cube import CrowdCube
from renderer.eye.kept import Kept
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
    crowd_cubes: dict[int, CrowdCube] = field(default_factory=dict)  # by size: large, slow to make
    kept: Kept = field(default_factory=Kept)  # what eyes are made of

    def crowd_cube(self, gl: moderngl.Context, size_px: int) -> CrowdCube:
        """Return the cube map of the moving people at a size."""
        if size_px not in self.crowd_cubes:
            self.crowd_cubes[size_px] = CrowdCube(gl, size_px, self.crowd)
        return self.crowd_cubes[size_px]


def scene_key(spec: ClipSpec) -> SceneKey:
    """Return what a scene depends on: surroundings, head, crowd."""
    around = (
        spec.environment,
        spec.environment_sha256,
        spec.environment_turn_deg,
        spec.environment_exposure_ev,
        spec.sun_azimuth_deg,
        spec.sun_elevation_deg,
    )
    pose = (spec.gaze_yaw_deg, spec.gaze_pitch_deg, spec.vergence_deg, spec.blink)
    policy = spec.lod_policy if spec.crowd > PAINTED_CROWD else None  # for people with real eyes
    return around, pose, (spec.crowd, policy)


def build_scene(gl: moderngl.Context, spec: ClipSpec, *, last: Scene | None = None) -> Scene:
    """Build the scene of a clip, out of the parts of the ``last`` one that stay the same."""
    key = scene_key(spec)
    same = [a == b for a, b in zip(key, last.key, strict=True)] if last else [False] * 3
    surroundings = last.surroundings if last and same[0] else Surroundings(gl, spec)
    head = last.head if last and same[1] else Head(gl, spec)
    # Another object of the same light would make the head bake it anew.
    is_lit = last is not None and same[0] and same[1]
    light = last.light if last and is_lit else build_light(gl, surroundings.sky, head)
    kept = last.kept if last else Kept()
    if last and same[0] and same[2]:
        crowd = last.crowd
        crowd.light = light  # the same sun; the head's shadow may be another
        return Scene(key, surroundings, head, light, crowd, last.crowd_cubes, kept)
    crowd = Crowd(gl, spec, light, static_cube=surroundings.cube)
    return Scene(key, surroundings, head, light, crowd, kept=kept)
