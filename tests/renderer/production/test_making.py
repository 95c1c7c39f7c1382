"""A clip's bounds are held or reported; its master has every frame, bit for bit."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.encoding.comparison import NOT_ASKED, SAME_LODS, SWITCHING
from renderer.encoding.decode import decode
from renderer.encoding.flip import WHY_NOT
from renderer.lod.policy import default_policy
from renderer.production.making import make_clip

LOW, ULTRA = Detail.uniform("low"), Detail.uniform("ultra")
SMALL = ClipSpec(left=LOW, right=ULTRA, width=128, height=64, duration_s=0.2)


@dataclass(frozen=True)
class Picture:
    pixels: np.ndarray
    visible_px: tuple[int, int] = (1, 1)


@dataclass
class Clouds:
    """Soft noise that moves; its LoDs differ by ``step`` in a checkered half of the pixels."""

    step: int = 60
    roughness: int = 12
    gl_renderer: str = "pattern"
    gl_version: str = "1"
    asked: list[tuple[str, int]] = field(default_factory=list)

    def frames(self, spec: ClipSpec, numbers: Sequence[int] | None = None) -> Iterator[Picture]:
        chosen = list(range(spec.frame_count) if numbers is None else numbers)
        self.asked.append((spec.left.texture, len(chosen)))
        y, x = np.mgrid[: spec.height, : spec.width]
        checks = ((x // 8 + y // 8) % 2 * (spec.left != LOW))[..., None]
        for number in chosen:
            noise = np.random.default_rng(number).integers(
                0, self.roughness, (spec.height, spec.width, 3)
            )
            level = 60 + x[..., None] % 64 + number + noise + self.step * checks
            yield Picture(level.clip(0, 255).astype(np.uint8))


def test_a_soft_clip_holds_both_bounds_and_says_what_it_cost(tmp_path: Path) -> None:
    source = Clouds(step=120, roughness=2)
    record = make_clip(SMALL, tmp_path / "clip.mp4", source=source)
    assert record.missed == []
    assert record.file_bytes < 100_000
    assert record.max_bytes == 1_600_000
    assert record.flip_encoding is not None
    assert record.flip_lods is not None
    assert sum(record.flip_encoding) <= 0.1 * sum(record.flip_lods)
    assert record.flip_note == ""
    assert record.flip_share == pytest.approx(
        sum(record.flip_encoding) / sum(record.flip_lods), abs=1e-3
    )
    assert record.flip_floor is not None
    assert 0 < record.flip_floor < record.flip_share
    assert source.asked == [("low", 6), ("ultra", 3)]  # nothing is drawn twice
    assert [path.name for path in tmp_path.iterdir()] == ["clip.mp4"]


def test_lods_that_hardly_differ_are_reported_with_what_the_form_allows(tmp_path: Path) -> None:
    source = Clouds(step=1, roughness=80)
    record = make_clip(SMALL, tmp_path / "clip.mp4", source=source)
    assert record.flip_floor is not None
    assert record.flip_floor > 0.1  # no encoding of this form can hold the bound
    (missed,) = record.missed
    assert "of FLIP between its LoDs; at most 0.1 is accepted; 8 bits of 4:2:0 alone" in missed
    assert float(missed.rpartition(" ")[2]) == pytest.approx(record.flip_floor, abs=1e-3)
    assert [path.name for path in tmp_path.iterdir()] == ["clip.mp4"]


def test_noise_is_made_to_fit_while_it_is_encoded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hard = ClipSpec(left=LOW, right=LOW, width=192, height=108, duration_s=2.0)
    source = Clouds(roughness=190)
    free = make_clip(hard, tmp_path / "free.mp4", source=source, with_flip=False)
    monkeypatch.setattr("renderer.encoding.bounds.MAX_BYTES", free.file_bytes)
    record = make_clip(hard, tmp_path / "clip.mp4", source=source, with_flip=False)
    assert record.max_bytes == round(free.file_bytes * 2 / 5)
    assert 0.6 * record.max_bytes < record.file_bytes <= record.max_bytes
    assert record.missed == []
    assert len(source.asked) == 2


def test_what_cannot_fit_is_kept_and_marked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("renderer.encoding.bounds.MAX_BYTES", 5000)
    record = make_clip(SMALL, tmp_path / "clip.mp4", source=Clouds(), with_flip=False)
    found = f"{record.file_bytes / 1e6:.2f}"
    assert record.missed == [f"the file has {found} MB; at most 0.00 MB are accepted"]
    assert len(decode(tmp_path / "clip.mp4", [0, 5], size=(128, 64))) == 2


def test_a_master_has_the_very_frames_that_were_drawn(tmp_path: Path) -> None:
    master = tmp_path / "clip.mkv"
    record = make_clip(
        SMALL, tmp_path / "clip.mp4", source=Clouds(roughness=190), master=master, with_flip=False
    )
    frames = decode(master, range(SMALL.frame_count), size=(128, 64))
    raw = hashlib.sha256(b"".join(frame.tobytes() for frame in frames.values())).hexdigest()
    assert raw == record.raw_sha256
    assert record.master == {
        "file": f"{SMALL.clip_id}.master.mkv",
        "sha256": hashlib.sha256(master.read_bytes()).hexdigest(),
        "bytes": master.stat().st_size,
    }


def test_flip_that_was_not_measured_is_null_and_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = Clouds()
    record = make_clip(SMALL, tmp_path / "a.mp4", source=source, with_flip=False)
    assert (record.flip_encoding, record.flip_lods, record.flip_note) == (None, None, NOT_ASKED)
    assert len(source.asked) == 1
    alike = ClipSpec(left=LOW, right=LOW, width=128, height=64, duration_s=0.1)
    record = make_clip(alike, tmp_path / "b.mp4", source=source)
    assert record.flip_encoding == record.flip_rectangle is not None
    assert (record.flip_lods, record.flip_note) == (None, SAME_LODS)
    monkeypatch.setattr("renderer.encoding.comparison.is_installed", lambda: False)
    record = make_clip(SMALL, tmp_path / "c.mp4", source=source)
    assert (record.flip_encoding, record.flip_note) == (None, WHY_NOT)


def test_an_eye_that_switches_has_no_difference_to_be_measured_by(tmp_path: Path) -> None:
    policy = default_policy()
    spec = ClipSpec(
        left=policy.finest,
        right=policy.finest,
        left_switching="blended",
        lod_policy=policy,
        motion="approach",
        width=128,
        height=64,
        duration_s=0.1,
    )
    source = Clouds(step=1)
    record = make_clip(spec, tmp_path / "clip.mp4", source=source)
    assert (record.flip_lods, record.flip_share, record.flip_floor) == (None, None, None)
    assert record.flip_note == SWITCHING
    assert record.missed == []
    assert len(source.asked) == 1
