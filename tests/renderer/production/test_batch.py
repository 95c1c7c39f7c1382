"""The batch: nothing is rendered twice, a kill costs one clip at most."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.lod.policy import default_policy
from renderer.manifest import MANIFEST_NAME, ClipRecord, read_manifest
from renderer.production.batch import render_clip, render_clips
from renderer.production.drawing import DrawnClip
from renderer.production.making import finish_clip

SPEC = ClipSpec(
    left=Detail.uniform("low"), right=Detail.uniform("ultra"), width=96, height=64, duration_s=0.4
)


@dataclass(frozen=True)
class Picture:
    pixels: np.ndarray
    visible_px: tuple[int, int]


@dataclass
class Pattern:
    """A source of moving gradients that counts what it was asked for."""

    gl_renderer: str = "pattern"
    gl_version: str = "1"
    asked: list[str] = field(default_factory=list)

    def frames(self, spec: ClipSpec, numbers: Sequence[int] | None = None) -> Iterator[Picture]:
        self.asked.append(spec.clip_id if numbers is None else f"{len(numbers)} others")
        y, x = np.mgrid[: spec.height, : spec.width]
        for number in range(spec.frame_count) if numbers is None else numbers:
            level = np.stack([x + number, y + spec.iris_seed, x + y], axis=-1) % 200
            yield Picture(level.astype(np.uint8), (number, 2 * number))


def test_a_clip_is_rendered_once_and_described_whole(tmp_path: Path) -> None:
    source = Pattern()
    first = render_clip(SPEC, tmp_path, source=source)
    again = render_clip(SPEC, tmp_path, source=source)
    assert again == first
    assert source.asked == [SPEC.clip_id, "3 others"]
    assert first.clip_spec == SPEC
    assert (tmp_path / first.file).stat().st_size == first.file_bytes
    assert first.visible_px == [[n, 2 * n] for n in range(SPEC.frame_count)]
    assert len(first.iris_px) == SPEC.frame_count == first.frame_count
    assert min(first.psnr_db) > 30
    assert min(first.ssim) > 0.9


def test_the_manifest_proves_equal_frames(tmp_path: Path) -> None:
    one = render_clip(SPEC, tmp_path / "a", source=Pattern())
    two = render_clip(SPEC, tmp_path / "b", source=Pattern())
    other = render_clip(replace(SPEC, iris_seed=9), tmp_path / "b", source=Pattern())
    assert (one.raw_sha256, one.file_sha256) == (two.raw_sha256, two.file_sha256)
    assert other.raw_sha256 != one.raw_sha256


def test_a_lost_or_cut_file_is_rendered_again(tmp_path: Path) -> None:
    source = Pattern()
    record = render_clip(SPEC, tmp_path, source=source)
    (tmp_path / record.file).write_bytes(b"cut")
    assert render_clip(SPEC, tmp_path, source=source) == replace(
        record,
        frame_ms_median=pytest.approx(record.frame_ms_median, abs=1e3),
        render_s=pytest.approx(record.render_s, abs=1e3),
    )
    assert source.asked == 2 * [SPEC.clip_id, "3 others"]


def test_a_master_is_kept_on_request_and_made_once(tmp_path: Path) -> None:
    source = Pattern()
    plain = render_clip(SPEC, tmp_path, source=source, with_flip=False)
    assert plain.master is None
    assert not list(tmp_path.glob("*.mkv"))
    kept = render_clip(SPEC, tmp_path, source=source, with_flip=False, with_master=True)
    assert kept.master is not None
    assert (tmp_path / kept.master["file"]).stat().st_size == kept.master["bytes"]
    assert kept.file_sha256 == plain.file_sha256  # people see the same clip
    assert render_clip(SPEC, tmp_path, source=source, with_master=True) == kept
    assert render_clip(SPEC, tmp_path, source=source) == kept
    assert source.asked == 2 * [SPEC.clip_id]
    assert not list(tmp_path.glob(".*.part.*"))


def test_a_damaged_manifest_is_refused_by_name(tmp_path: Path) -> None:
    (tmp_path / MANIFEST_NAME).write_text("{not json")
    with pytest.raises(ValueError, match=r"manifest\.json: not a manifest of schema 2"):
        render_clip(SPEC, tmp_path, source=Pattern())


KILLED = """
import os, signal, sys
sys.path.insert(0, sys.argv[2])
from test_batch import SPEC, Pattern, render_clips, replace
from pathlib import Path
class Dying(Pattern):
    def frames(self, spec, numbers=None):
        for number, frame in enumerate(super().frames(spec, numbers)):
            if len(self.asked) == 5 and number == 5:
                os.kill(os.getpid(), signal.SIGKILL)
            yield frame
render_clips([SPEC, replace(SPEC, iris_seed=2), replace(SPEC, iris_seed=3)], Path(sys.argv[1]),
             source=Dying())
"""


def test_after_kill_9_the_batch_resumes_and_keeps_what_was_done(tmp_path: Path) -> None:
    here = Path(__file__).parent
    killed = subprocess.run(
        [sys.executable, "-c", KILLED, str(tmp_path), str(here)],
        env=os.environ | {"PYTHONPATH": str(here.parents[2])},
        check=False,
    )
    assert killed.returncode == -signal.SIGKILL
    assert list(read_manifest(tmp_path).clips) == [SPEC.clip_id]  # the second was compared yet
    host = socket.gethostname().replace(".", "-")
    left = {path.suffix for path in tmp_path.glob(".*.part.*")}
    assert left == {".mp4"}  # the second and the third clip's, of the killed process
    at_work = [f".{SPEC.clip_id}.{host}.{os.getpid()}.part.mp4"]
    at_work += [f".{SPEC.clip_id}.elsewhere.{_gone_pid()}.part.mp4"]
    for name in at_work:
        (tmp_path / name).write_bytes(b"at work")
    source = Pattern()
    specs = [SPEC, replace(SPEC, iris_seed=2), replace(SPEC, iris_seed=3)]
    heard: list[tuple[int, float]] = []
    records = render_clips(
        specs, tmp_path, source=source, progress=lambda n, s: heard.append((n, s))
    )
    assert source.asked[::2] == [spec.clip_id for spec in specs[1:]]
    assert [record.clip_id for record in records] == [spec.clip_id for spec in specs]
    assert {path.name for path in tmp_path.glob(".*.part.*")} == set(at_work)
    assert heard[0] == (0, 1.0)
    assert heard[-1] == (2, 1.0)
    assert len(json.loads((tmp_path / MANIFEST_NAME).read_text())["clips"]) == 3


def test_a_clip_that_fails_leaves_nothing_behind(tmp_path: Path) -> None:
    def stop(_share: float) -> None:
        raise RuntimeError("stopped")

    with pytest.raises(RuntimeError, match="stopped"):
        render_clip(SPEC, tmp_path, source=Pattern(), progress=stop)
    assert list(tmp_path.iterdir()) == []


def _gone_pid() -> int:
    """Return the number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_the_manifest_says_which_lod_each_eye_had(tmp_path: Path) -> None:
    policy = default_policy()
    spec = replace(
        SPEC,
        left=policy.finest,
        right=policy.finest,
        motion="approach",
        approach_end_px=100.0,
        left_switching="blended",
        lod_policy=policy,
    )
    record = render_clip(spec, tmp_path, source=Pattern())
    assert len(record.lod_places) == spec.frame_count
    assert {row[1] for row in record.lod_places} == {len(policy.steps) - 1.0}
    assert [row[0] for row in record.iris_px] == sorted(row[0] for row in record.iris_px)
    again = read_manifest(tmp_path).clips[spec.clip_id]
    assert again.lod_places == record.lod_places
    assert again.clip_spec == spec
    assert render_clip(SPEC, tmp_path, source=Pattern()).lod_places == []


@dataclass
class Here:
    """Stands in for the other process: finishes at once, or was killed."""

    error: Exception | None = None

    def start(self, drawn: DrawnClip) -> Future[ClipRecord]:
        future: Future[ClipRecord] = Future()
        if self.error is None:
            future.set_result(finish_clip(drawn))
        else:
            future.set_exception(self.error)
        return future

    def close(self) -> None:
        pass


def test_a_clip_comes_in_while_the_next_one_is_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("renderer.production.batch.Finishing", Here)
    there: list[int] = []
    render_clips(
        [SPEC, replace(SPEC, iris_seed=2)],
        tmp_path,
        source=Pattern(),
        progress=lambda number, _share: there.append(number * len(read_manifest(tmp_path).clips)),
    )
    drawing_second = there[SPEC.frame_count :]
    assert drawing_second[:-1] == [1] * SPEC.frame_count
    assert drawing_second[-1] == 2


def test_a_clip_whose_comparison_was_killed_is_compared_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    killed = Here(BrokenExecutor("killed"))
    monkeypatch.setattr("renderer.production.batch.Finishing", lambda: killed)
    records = render_clips([SPEC, replace(SPEC, iris_seed=2)], tmp_path, source=Pattern())
    assert list(read_manifest(tmp_path).clips) == [record.clip_id for record in records]


def test_what_is_drawn_is_kept_when_the_next_clip_fails(tmp_path: Path) -> None:
    def fail(number: int, _share: float) -> None:
        if number == 1:
            raise RuntimeError("stopped")

    with pytest.raises(RuntimeError, match="stopped"):
        render_clips([SPEC, replace(SPEC, iris_seed=2)], tmp_path, source=Pattern(), progress=fail)
    assert list(read_manifest(tmp_path).clips) == [SPEC.clip_id]
    assert not list(tmp_path.glob(".*.part.*"))
