"""What eyes share: made once, the same pixels, never more than it may take."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye import maps
from renderer.eye.kept import Kept, Same, fingerprint, size_bytes
from renderer.eye.maps import iris_values, sclera_values
from renderer.iris.source import Iris

HIGH = Detail.uniform("high")
SUN = np.array([0.0, 0.5, 0.866])
SPEC = ClipSpec(left=HIGH, right=HIGH, iris_seed=4, pupil_mm=3.0)
IRIS_PX = 64  # of the maps that irises are baked at here


@pytest.fixture
def irises(small: pytest.MonkeyPatch) -> None:
    """Bake irises that are coarse, and still one for each seed."""
    small.setattr(
        maps, "iris_of", lambda spec: Iris(spec.iris_seed, spec.iris_colour, "", "", IRIS_PX)
    )


def test_a_thing_is_made_once_per_key() -> None:
    kept, made = Kept(), []

    def make() -> int:
        made.append(1)
        return len(made)

    assert [kept.get("a", make), kept.get("a", make), kept.get("b", make)] == [1, 1, 2]


def test_what_was_used_last_stays_within_the_limit() -> None:
    kept = Kept(limit_bytes=2500)
    for key in ("a", "b"):
        kept.get(key, lambda: np.zeros(1000, np.uint8))
    kept.get("a", lambda: pytest.fail("a is kept"))
    kept.get("c", lambda: np.zeros(1000, np.uint8))
    assert kept.used_bytes == 2000
    kept.get("a", lambda: pytest.fail("a was used after b"))
    assert kept.get("b", lambda: np.ones(500, np.uint8))[0] == 1  # made anew
    assert kept.used_bytes == 2500


def test_the_newest_stays_however_large() -> None:
    kept = Kept(limit_bytes=10)
    kept.get("a", lambda: np.zeros(8, np.uint8))
    kept.get("b", lambda: np.zeros(4000, np.uint8))
    assert kept.used_bytes == 4000
    kept.get("b", lambda: pytest.fail("b is kept"))


def test_an_object_without_a_value_is_a_key_by_itself() -> None:
    first, second = [1], [1]
    assert Same(first) == Same(first)
    assert Same(first) != Same(second)
    assert len({Same(first), Same(first), Same(second)}) == 2


def test_a_fingerprint_tells_shape_type_and_numbers() -> None:
    numbers = np.arange(6.0)
    assert fingerprint(numbers) == fingerprint(numbers.copy())
    others = (numbers + 1e-12, numbers.reshape(2, 3), numbers.astype(np.float32))
    assert len({fingerprint(other) for other in (numbers, *others)}) == 4


def test_a_texture_counts_its_mips(gl: moderngl.Context) -> None:
    texture = gl.texture((64, 32), 4, dtype="f2")
    assert size_bytes({"one": texture, "two": texture}) == 2 * int(64 * 32 * 4 * 2 * 4 / 3)


@pytest.mark.usefixtures("irises")
def test_both_eyes_and_the_next_clip_read_the_same_textures(gl: moderngl.Context) -> None:
    kept = Kept()
    values = iris_values(gl, SPEC, HIGH, sun_eye=SUN, kept=kept)
    again = iris_values(gl, replace(SPEC, pupil_mm=5.0), HIGH, sun_eye=-SUN, kept=kept)
    shared = {name for name in values if values[name] is again[name]}
    assert {"u_iris_albedo", "u_iris_normal", "u_iris_height", "u_thickness"} <= shared
    assert again["u_pupil_mm"] == 5.0
    white = sclera_values(gl, SPEC, HIGH, kept=kept)
    assert sclera_values(gl, SPEC, HIGH, kept=kept)["u_sclera_albedo"] is white["u_sclera_albedo"]


@pytest.mark.usefixtures("irises")
def test_another_iris_or_level_has_textures_of_its_own(gl: moderngl.Context) -> None:
    kept = Kept()
    values = [
        iris_values(gl, SPEC, HIGH, sun_eye=SUN, kept=kept),
        iris_values(gl, SPEC, Detail.uniform("low"), sun_eye=SUN, kept=kept),
        iris_values(gl, replace(SPEC, iris_seed=5), HIGH, sun_eye=SUN, kept=kept),
    ]
    assert len({id(each["u_iris_albedo"]) for each in values}) == 3
    assert len({id(each["u_thickness"]) for each in values}) == 3


@pytest.mark.usefixtures("irises")
def test_shared_textures_hold_what_own_ones_hold(gl: moderngl.Context) -> None:
    kept = Kept()
    iris_values(gl, SPEC, HIGH, sun_eye=SUN, kept=kept)
    shared = iris_values(gl, SPEC, HIGH, sun_eye=SUN, kept=kept)
    own = iris_values(gl, SPEC, HIGH, sun_eye=SUN)
    for name in ("u_iris_albedo", "u_iris_normal", "u_iris_height", "u_thickness"):
        assert shared[name] is not own[name]
        assert shared[name].read() == own[name].read()
