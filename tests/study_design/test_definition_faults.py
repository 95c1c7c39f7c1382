"""Every fault of a study file is told at once: where, what was found, what is accepted."""

from __future__ import annotations

import copy
import functools
import json
import random
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from study.design.definition import parse_definition, read_definition
from study.design.faults import KINDS, DefinitionError

Raw = dict[str, Any]
Change = Callable[[Raw], object]


def messages(raw: Raw) -> list[str]:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw, source="thesis.toml")
    return str(caught.value).splitlines()


CASES: list[tuple[Change, str]] = [
    (
        lambda raw: raw["lods"]["ultra"].update(reflection="hihg"),
        'lods.ultra.reflection: unknown level "hihg"; choose one of off, low, medium, high, ultra; '
        'did you mean "high"?',
    ),
    (
        lambda raw: raw["lods"]["low"].pop("sclera"),
        "lods.low: no level for sclera; give every effect a level, or name a LoD to start from: "
        'base = "ultra"',
    ),
    (
        lambda raw: raw["lods"]["no-caustics"].update(base="ultar"),
        'lods.no-caustics.base: unknown LoD "ultar"; choose one of low, ultra; did you mean '
        '"ultra"?',
    ),
    (
        lambda raw: raw["lods"].update(x={"base": "y"}, y={"base": "x"}),
        'lods.x.base: "y" leads back to "x"',
    ),
    (
        lambda raw: raw["lods"]["low"].update(caustic="low"),
        'lods.low.caustic: unknown key "caustic"; choose one of base, switching, texture, '
        "refraction, reflection, subsurface, caustics, tessellation, sclera; "
        'did you mean "caustics"?',
    ),
    (
        lambda raw: raw["clips"][0].update(left="lo"),
        'clips.0.left: unknown LoD "lo"; choose one of low, ultra, no-caustics; did you mean '
        '"low"?',
    ),
    (
        lambda raw: raw["clips"][1].update(distance="medium"),
        'clips.1.distance: unknown distance "medium"; choose one of near, far',
    ),
    (
        lambda raw: raw["clips"][1].update(distance="fra"),
        'clips.1.distance: unknown value "fra"; choose one of macroscopic, near, medium, far',
    ),
    (
        lambda raw: raw["clips"][1].update(id="p"),
        'clips.1.id: id "p" is taken by practice.0.id; ids must differ',
    ),
    (
        lambda raw: raw["clips"][1].update(id="Clip B"),
        'clips.1.id: "Clip B" is no name; use 1 to 60 lower-case letters, digits, "-" and "_", '
        "with a letter or digit at either end",
    ),
    (
        lambda raw: raw.update(clips=[]),
        "clips: no clip; write [[clips]] tables or [[factors]] that generate them",
    ),
    (
        lambda raw: raw.update(
            factors=[{"distances": ["far"], "lods": ["lwo"], "against": ["ultra"]}]
        ),
        'factors.0.lods: unknown LoD "lwo"; choose one of low, ultra, no-caustics; did you mean '
        '"low"?',
    ),
    (
        lambda raw: raw.update(catch=[{"distance": "far", "lod": "high"}]),
        'catch.0.lod: unknown LoD "high"; choose one of low, ultra, no-caustics',
    ),
    (
        lambda raw: raw.update(catch=[{"distance": "far", "lod": "low"}] * 2),
        'catch.1: id "catch-far-low" is taken by catch.0; ids must differ',
    ),
    (
        lambda raw: raw.update(sizes=["320x180", "322x180"]),
        "sizes.1: width: 322 cannot be halved into two even views; use a multiple of 4",
    ),
    (
        lambda raw: raw.update(sizes=["320x181"]),
        "sizes.0: height: 181 is odd; H.264 in 4:2:0 needs an even number of pixels",
    ),
    (
        lambda raw: raw.update(sizes=["320 by 180"]),
        'sizes.0: "320 by 180" is no size; write width x height in pixels, like "1280x720"',
    ),
    (lambda raw: raw.update(sizes=["320x180"] * 2), 'sizes: "320x180" is listed twice'),
    (
        lambda raw: raw["orbit"].update(directions=["leftward", "leftward"]),
        'orbit.directions: "leftward" is listed twice',
    ),
    (
        lambda raw: raw.update(eye={"pupil_mm": 20.0}),
        "eye.pupil_mm: 20.0 lies outside 1.5 to 8.0",
    ),
    (
        lambda raw: raw.update(scene={"sun_elevation_deg": True}),
        "scene.sun_elevation_deg: expected a number; found True",
    ),
    (lambda raw: raw.pop("consent"), "consent: missing; this key is required"),
    (lambda raw: raw.update(title="  "), "title: empty; write some text or leave the key out"),
    (
        lambda raw: raw["questions"][0].pop("kind"),
        f"questions.0.kind: missing; choose one of {', '.join(KINDS)}",
    ),
    (
        lambda raw: raw["about"][0].update(kind="numbre"),
        f'about.0.kind: unknown kind "numbre"; choose one of {", ".join(KINDS)}; did you '
        'mean "number"?',
    ),
    (
        lambda raw: raw["about"][0].update(minimum=99),
        "about.0.maximum: 99 is not above minimum 99",
    ),
    (
        lambda raw: raw["questions"][1].update(max_char=3),
        'questions.1.max_char: unknown key "max_char"; choose one of id, text, help, is_required, '
        'shown_if, kind, max_chars, is_long; did you mean "max_chars"?',
    ),
    (
        lambda raw: raw["questions"][1]["shown_if"].update(question="notised"),
        'questions.1.shown_if.question: unknown earlier question "notised"; choose one of '
        'noticed; did you mean "noticed"?',
    ),
    (
        lambda raw: raw["questions"][1]["shown_if"].update(values=["yep"]),
        'questions.1.shown_if.values: unknown answer "yep"; choose one of yes, no, unsure; did '
        'you mean "yes"?',
    ),
    (
        lambda raw: raw["questions"][2].update(id="noticed"),
        'questions.2.id: id "noticed" is taken by questions.0.id; ids must differ',
    ),
    (
        lambda raw: raw["questions"][2].update(id="comments"),
        'questions.2.kind: "scale" does not fit the column comments; make it "text" or give the '
        "question another id",
    ),
    (
        lambda raw: raw["questions"][2].update(highest=7),
        "questions.2: 6, 7 cannot be stored in the column rating_left; its values are 1, 2, 3, 4, "
        "5",
    ),
    (
        lambda raw: raw["questions"][0]["options"][1].update(value="yes"),
        "questions.0.options: two options have the same value",
    ),
]


@pytest.mark.parametrize(("change", "expected"), CASES, ids=[case[1][:40] for case in CASES])
def test_a_fault_says_where_what_and_what_is_accepted(
    raw: Raw, change: Change, expected: str
) -> None:
    change(raw)
    assert f"thesis.toml: {expected}" in messages(raw)


def test_all_faults_are_reported_at_once(raw: Raw) -> None:
    raw["lods"]["ultra"]["reflection"] = "hihg"
    raw["clips"][0]["distanse"] = raw["clips"][0].pop("distance")
    raw["clips"][1]["left"] = "nobody"
    del raw["thanks"]
    places = [line.split(": ")[1] for line in messages(raw)]
    assert places == [
        *("lods.ultra.reflection", "clips.0.distance", "clips.0.distanse", "thanks"),
        "clips.1.left",
    ]


JUNK: list[Any] = [None, 0, -1, 1.5, True, "", "x", "low", [], {}, [1], {"a": 1}, [[]], 10**30]


def places(found: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the place of every value in nested tables and lists."""
    pairs = found.items() if isinstance(found, dict) else enumerate(found)
    for key, value in pairs:
        yield (*place, key)
        if isinstance(value, dict | list):
            yield from places(value, (*place, key))


def test_damage_anywhere_is_told_and_never_a_crash() -> None:
    rng = random.Random(1)
    sound = json.loads(read_definition("lod").to_json())
    told = 0
    for _ in range(150):
        damaged = copy.deepcopy(sound)
        *inner, last = rng.choice(list(places(damaged)))
        holder = functools.reduce(lambda table, key: table[key], inner, damaged)
        holder[last] = rng.choice(JUNK)
        try:
            parse_definition(damaged)
        except DefinitionError as error:
            told += len(error.faults) > 0
    assert told > 100


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (("eye",), 3, "eye: expected a table; found 3"),
        (("sizes",), "320x180", "sizes: expected a list; found '320x180'"),
        (("title",), 3, "title: expected text in quotes; found 3"),
        (("orbit", "fps"), "30", "orbit.fps: expected a whole number; found '30'"),
        (("orbit", "fps"), 29.5, "orbit.fps: expected a whole number; found 29.5"),
        (
            ("questions", 0, "is_required"),
            "no",
            "questions.0.is_required: expected true or false; found 'no'",
        ),
        (("lods", "low", "base"), {}, "lods.low.base: expected text in quotes; found {}"),
        (("order",), {"min_views": 0}, "order.min_views: input should be greater than or equal to"),
        (
            ("order",),
            {"trials": "shuffled"},
            "order.trials: input should be 'random', 'balanced' or 'file'",
        ),
    ],
)
def test_a_value_of_the_wrong_kind_is_told_in_the_files_words(
    raw: Raw, place: tuple[Any, ...], value: Any, message: str
) -> None:
    *inner, last = place
    holder = functools.reduce(lambda table, key: table[key], inner, raw)
    holder[last] = value
    assert any(line.startswith(f"thesis.toml: {message}") for line in messages(raw))


def test_a_sound_file_has_no_fault(raw: Raw) -> None:
    assert parse_definition(raw).key == "small"


@pytest.mark.parametrize("key", ["lods", "clips", "questions", "sizes", "distances", "orbit"])
@pytest.mark.parametrize("nonsense", [3, "x", [1], [[]], {"a": 1}, [{"id": 3}], [None]])
def test_nonsense_anywhere_is_a_fault_and_never_a_crash(raw: Raw, key: str, nonsense: Any) -> None:
    raw[key] = nonsense
    assert messages(raw)
