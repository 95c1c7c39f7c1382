"""A scene is built out of the last one's parts, as far as a clip leaves them the same."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from renderer import scene as scenes
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.lod.policy import default_policy

SPEC = ClipSpec(left=Detail(), right=Detail())
PARTS = ("surroundings", "head", "crowd")


class Part:
    """Stands for a part of the scene; knows the light and the sky that it was built with."""

    def __init__(self, _gl: Any, _spec: ClipSpec, light: Any = None, **_more: Any) -> None:
        self.light = light
        self.cube = object()
        self.sky = object()


@pytest.fixture(autouse=True)
def parts(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("Surroundings", "Head", "Crowd"):
        monkeypatch.setattr(scenes, name, type(name, (Part,), {}))
    monkeypatch.setattr(scenes, "build_light", lambda _gl, sky, head: (sky, head))


@pytest.mark.parametrize(
    ("changed", "rebuilt"),
    [
        ({"iris_colour": "brown", "distance": "far"}, set()),
        ({"gaze_pitch_deg": -10.0}, {"head"}),
        ({"vergence_deg": 4.0}, {"head"}),
        ({"blink": 0.5}, {"head"}),
        ({"crowd": 0}, {"crowd"}),
        ({"sun_azimuth_deg": 30.0}, {"surroundings", "crowd"}),
        ({"environment": "image", "environment_sha256": "0" * 64}, {"surroundings", "crowd"}),
    ],
)
def test_only_what_a_clip_changes_is_built_anew(
    changed: dict[str, Any], rebuilt: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("renderer.clip.clip_faults", lambda *_: [])
    gl: Any = None
    last = scenes.build_scene(gl, SPEC)
    scene = scenes.build_scene(gl, replace(SPEC, **changed), last=last)
    assert {name for name in PARTS if getattr(scene, name) is not getattr(last, name)} == rebuilt
    assert scene.light == (scene.surroundings.sky, scene.head)
    assert (scene.light is last.light) == (not rebuilt & {"surroundings", "head"})
    assert scene.crowd.light is scene.light
    assert (scene.key == last.key) == (not rebuilt)


def test_only_people_with_real_eyes_stand_by_a_clips_policy() -> None:
    eyes = {"left_switching": "blended", "lod_policy": default_policy()}
    left = default_policy().finest
    keys = {
        crowd: (
            scenes.scene_key(replace(SPEC, crowd=crowd)),
            scenes.scene_key(replace(SPEC, crowd=crowd, left=left, **eyes)),
        )
        for crowd in (0, 5, 10, 30)
    }
    assert [crowd for crowd, (fixed, switching) in keys.items() if fixed != switching] == [10, 30]
