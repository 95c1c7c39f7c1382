"""The parts on a small picture of the shared scene: what they draw, and what their rows say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from renderer.benchmark import crowd, cubes, lods
from renderer.benchmark.clock import QUERY
from renderer.benchmark.effects import is_none, levels_of
from renderer.benchmark.plan import Progress, guess_s, run_bench, steps_of
from renderer.benchmark.result import PARTS, About, Bench
from renderer.benchmark.stand import ONE, Stand, processor
from renderer.benchmark.startup import caches_in, in_fresh_process
from renderer.benchmark.work import count_pixels
from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, Detail
from renderer.eye.cube_size import cube_px

AUTO = ClipSpec(left=Detail(), right=Detail(), width=96, height=64, cube_size="auto")


def empty(stand: Stand) -> Bench:
    about = About(
        renderer="", gl_version="", clock=stand.clock, size="96x64", code_version="", cores=1,
        processor="", load_before=0.0, is_quick=True, seconds=0.0,
    )  # fmt: skip
    return Bench(about=about)


def test_levels_that_are_none_are_not_measured() -> None:
    assert levels_of("texture") == ("off", "low", "medium", "high", "ultra")
    assert levels_of("caustics") == ("off", "high", "ultra")
    assert levels_of("reflection") == ("off", "medium", "high", "ultra")
    assert levels_of("reflection", is_quick=True) == ("off", "ultra")
    assert is_none("refraction", "medium")
    assert not is_none("refraction", "high")


@pytest.mark.parametrize("is_quick", [True, False])
def test_a_plan_has_every_part_once_in_order(is_quick: bool) -> None:
    steps = steps_of(PARTS, is_quick=is_quick)
    assert list(dict.fromkeys(step.part for step in steps)) == list(PARTS)
    assert all(step.weight > 0 for step in steps)
    assert [step.part for step in steps_of(("work",), is_quick=is_quick)] == ["work"]


def test_a_full_plan_times_every_effect_from_both_bases() -> None:
    titles = [step.title for step in steps_of(("effects",), is_quick=False)]
    assert titles == [f"{effect} from {base}" for base in ("low", "ultra") for effect in EFFECTS]


def test_frames_of_each_lod_are_timed(stand: Stand, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lods, "STANDARD_LODS", ("low", "medium"))
    bench = empty(stand)
    step = next(s for s in lods.lod_steps(2, is_quick=True) if s.title == "macroscopic, one eye")
    step.measure(stand, bench)
    assert [row.lod for row in bench.rows] == ["low", "medium"]
    for row in bench.rows:
        assert (row.part, row.size, row.distance, row.eyes) == ("lods", "96x64", "macroscopic", 1)
        assert row.processor_ms is not None
        assert 0.0 < row.processor_ms < row.ms_median
        assert row.draw_calls is not None
        assert row.draw_calls > 20
        assert (row.row_ms, row.wait_ms, row.gaps) == (None, None, None)  # a GPU's alone
        assert row.iris_px == pytest.approx(350 * 64 / 1080, abs=0.01)
        assert row.ms_median > 0
        assert row.n == 2


def test_a_group_is_timed_with_all_its_eyes(stand: Stand, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crowd, "CROWDS", (0, 5))
    bench = empty(stand)
    large = Stand(stand.studio, (1280, 720), rounds=1)
    crowd.crowd_steps(1, is_quick=True)[1].measure(large, bench)
    (row,) = bench.rows
    assert (row.part, row.distance, row.lod, row.crowd) == ("crowd", "group", "by size", 5)
    assert 0 < row.eyes <= 10
    assert row.iris_px > 4.0
    assert row.ms_median > 0


def test_timer_queries_run_where_the_wall_clock_is_better(
    stand: Stand, monkeypatch: pytest.MonkeyPatch
) -> None:
    frames = stand.frames(stand.spec(Detail.uniform("low")))
    monkeypatch.setattr(frames, "render", None)  # reading back is no part of a GPU's time
    monkeypatch.setattr("renderer.benchmark.clock.ROW", 2)
    stand.clock = QUERY
    (shots,) = stand.time([frames], are_whole=True)
    assert all(0.0 < shot.ms < 4294.0 for shot in shots)  # 2^32 ns: a query that went wrong
    row = stand.frame_row("lods", frames.spec, shots, lod="low")
    assert row.draw_calls is not None
    assert row.draw_calls > 20
    assert row.row_ms is not None
    assert row.wait_ms is not None
    assert 0.0 <= row.wait_ms < row.row_ms
    assert row.gaps in range(row.n + 1)


def test_a_cube_of_another_size_is_mirrored_and_the_scene_keeps_its_own(
    stand: Stand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cubes, "BASE", Detail())  # the other effects only take time to build
    small = cubes.mirroring(stand, "dynamic", 128)
    values = small.eye_models[0].values
    assert values["u_crowd_cube"].size == (128, 128)
    assert values["u_static_cube"].size == (128, 128)
    own = stand.frames(stand.spec(Detail(reflection="ultra")))
    assert own.eye_models[0].values["u_crowd_cube"].size == (2048, 2048)
    still = cubes.mirroring(stand, "static", 256).eye_models[0].values
    assert still["u_static_cube"].size == (256, 256)
    assert "u_crowd_cube" not in still
    assert small.render(0.0).visible_px[0] > 0


def test_clips_are_timed_with_the_cubes_that_their_setting_gives(
    stand: Stand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cubes, "BASE", Detail(reflection="ultra"))
    bench = empty(stand)
    cubes.cube_steps(1, is_quick=True)[-1].measure(stand, bench)
    sizes = {row.cube: row.cube_px for row in bench.rows}
    assert sizes == {"table": 2048, "auto": cube_px(Detail(reflection="ultra"), AUTO)}
    assert all(row.eyes == 2 and row.ms_median > 0 for row in bench.rows)


def test_the_time_is_guessed_from_pixels_and_cores(
    stand: Stand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    steps = steps_of(PARTS, is_quick=False)
    small, large = (
        guess_s(Stand(stand.studio, size, rounds=1), steps) for size in ((640, 360), (1920, 1080))
    )
    assert 60 < small < large < 30 * 60
    monkeypatch.setattr("os.cpu_count", lambda: 8)
    assert guess_s(Stand(stand.studio, (1920, 1080), rounds=1), steps) < large


def test_more_samples_fetch_more_where_the_iris_is(stand: Stand) -> None:
    layers = Detail(subsurface="ultra")
    values = stand.frames(stand.spec(layers)).eye_models[0].values
    gl = stand.studio.gl
    off = count_pixels(gl, stand.spec(Detail()), values)
    few, many = (
        count_pixels(gl, stand.spec(layers, subsurface_samples=samples), values)
        for samples in (2, 10)
    )
    np.testing.assert_array_equal(few[..., 0], many[..., 0])
    iris = few[..., 1] > off[..., 1]
    seen = few[..., 0] > 0
    assert 0.2 < iris.sum() / seen.sum() < 0.95  # the white has no layers
    # A fetch per sample and one for the depth; the loop's body is the same each time.
    assert np.unique((few - off)[iris][:, 1]).tolist() == [3.0]
    assert np.unique((many - off)[iris][:, 1]).tolist() == [11.0]
    assert np.unique((many - few)[iris][:, 2]).size == 1


def test_one_eye_leaves_the_other_off(stand: Stand) -> None:
    spec = stand.spec(Detail.uniform("high"), eyes=ONE)
    assert (spec.left, spec.right) == (Detail.uniform("high"), Detail())


def test_progress_is_told_before_each_step(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Progress] = []

    class Studio:
        gl = None
        gl_renderer, gl_version = "llvmpipe", "4.5"
        is_closed = False

        def close(self) -> None:
            Studio.is_closed = True

    monkeypatch.setattr("renderer.benchmark.plan.Studio", Studio)
    monkeypatch.setattr(
        "renderer.benchmark.startup.in_fresh_process",
        lambda _lod, size, _changes: {"bytes": {"textures": 2_000_000 * size[0]}, "seconds": {}},
    )
    bench = run_bench(("memory",), size=(64, 64), progress=told.append)
    assert [progress.title for progress in told] == [
        f"memory: {lod}" for lod in ("low", "medium", "high", "ultra")
    ]
    assert [progress.share for progress in told] == [0.0, 0.25, 0.5, 0.75]
    assert told[0].left_s > 0.0  # a guess, before anything is measured
    assert told[1].left_s < 60.0
    assert [item.megabytes for item in bench.memory] == [128.0] * 4
    assert bench.about.clock == "wall time"
    assert Studio.is_closed


def test_a_fresh_process_sets_up_and_weighs_a_lod() -> None:
    told = in_fresh_process("low", (64, 64), {})
    assert list(told["seconds"]) == [
        "modules", "context", "surroundings", "head", "light", "crowd", "targets", "first frame",
        "second frame",
    ]  # fmt: skip
    assert all(seconds > 0 for seconds in told["seconds"].values())
    assert told["bytes"]["textures"] > 1e6
    assert told["bytes"]["resident set"] > told["bytes"]["buffers"] > 1e5


def test_a_set_up_that_fails_says_why(tmp_path: Path) -> None:
    changes = caches_in(tmp_path)
    with pytest.raises(RuntimeError, match=r"setting up splendid failed \(1\): .*splendid"):
        in_fresh_process("splendid", (64, 64), changes)
    assert (tmp_path / "bakes").is_dir()


def test_the_processors_name_is_told(tmp_path: Path) -> None:
    told = tmp_path / "cpuinfo"
    told.write_text("processor : 0\nmodel name\t: Some CPU @ 3 GHz\n")
    assert processor(told) == "Some CPU @ 3 GHz"
    assert processor(tmp_path / "absent")
