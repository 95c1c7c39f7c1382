"""A batch on any executor: each clip once, a death costs its clip, nothing is trusted blindly."""

from __future__ import annotations

import _thread
import hashlib
import socket
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from renderer.cache import cache_folder
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.manifest import read_manifest
from renderer.production import farm, orders
from renderer.production.farm import BatchError, render_on
from renderer.sources import code_version
from study.commands.pool import Pool

SPEC = ClipSpec(
    left=Detail.uniform("low"),
    right=Detail.uniform("ultra"),
    distance="near",
    width=96,
    height=64,
    duration_s=0.2,
    fps=10,
)
HERE = Path(__file__).parent


def seeded(*seeds: int) -> list[ClipSpec]:
    return [replace(SPEC, iris_seed=seed) for seed in seeds]


@pytest.fixture
def fake(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """Let orders be filled by farm_orders, here and in processes that this one starts."""
    monkeypatch.syspath_prepend(HERE)
    monkeypatch.setenv("OCULARIST_TEST_FOLDER", str(tmp_path))
    import farm_orders

    monkeypatch.setattr(farm, "fill_order", farm_orders.fill)
    return farm_orders


@pytest.fixture
def here() -> Iterator[Executor]:
    with ThreadPoolExecutor(1) as executor:
        yield executor


def test_every_clip_is_rendered_once_and_kept_whole(
    fake: ModuleType, here: Executor, tmp_path: Path
) -> None:
    first = render_on(here, seeded(1), tmp_path / "clips")
    heard: list[int] = []
    twin = replace(SPEC, iris_seed=3)
    records = render_on(here, [*seeded(1, 2, 3), twin], tmp_path / "clips", progress=heard.append)
    assert fake.ordered() == [1, 2, 3]
    assert heard == [1, 2, 3]
    assert records[0] == first[0]
    assert records[2] is records[3]
    assert list(read_manifest(tmp_path / "clips").clips.values()) == records[:3]
    for record in records:
        data = (tmp_path / "clips" / record.file).read_bytes()
        assert hashlib.sha256(data).hexdigest() == record.file_sha256


class Asleep(Executor):
    """Never comes back; as the batch falls asleep, a signal comes that wakes nobody."""

    def submit(self, *_: Any, **__: Any) -> Future[Any]:
        timer = threading.Timer(0.3, _thread.interrupt_main)
        timer.daemon = True
        timer.start()
        return Future()


def test_ctrl_c_is_heard_even_by_a_batch_that_sleeps(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        render_on(Asleep(), seeded(1), tmp_path / "clips")


def test_a_killed_process_costs_only_its_clip(fake: ModuleType, tmp_path: Path) -> None:
    said: list[str] = []
    specs = seeded(1, fake.ONCE, 2, 3)
    with Pool(2, threads=1) as pool:
        records = render_on(pool, specs, tmp_path / "clips", say=said.append)
    assert [record.clip_spec for record in records] == specs
    assert sorted(fake.ordered()) == [1, 2, 3, fake.ONCE, fake.ONCE]
    name = f"near, 96x64, rightward ({specs[1].clip_id})"
    assert said == [f"{name}: its process was killed; trying again (2 of 3)"]
    assert list((tmp_path / "clips").glob(".*part*")) == []


def test_a_clip_that_kills_every_process_is_given_up_and_the_others_are_kept(
    fake: ModuleType, tmp_path: Path
) -> None:
    specs = seeded(fake.ALWAYS, 1, fake.FAULTY, 2)
    with Pool(2, threads=1) as pool, pytest.raises(BatchError) as failed:
        render_on(pool, specs, tmp_path / "clips")
    assert sorted(str(failed.value).splitlines()) == sorted(
        [
            f"near, 96x64, rightward ({specs[0].clip_id}): its process was killed, 3 times; "
            "is there too little memory?",
            f"near, 96x64, rightward ({specs[2].clip_id}): the iris is on holiday",
        ]
    )
    assert sorted(fake.ordered()) == [1, 2, *[fake.ALWAYS] * 3, fake.FAULTY]
    assert set(read_manifest(tmp_path / "clips").clips) == {specs[1].clip_id, specs[3].clip_id}


def test_a_clip_that_arrives_damaged_is_ordered_again(
    fake: ModuleType, here: Executor, tmp_path: Path
) -> None:
    said: list[str] = []
    (spec,) = seeded(fake.DAMAGED)
    (record,) = render_on(here, [spec], tmp_path / "clips", say=said.append)
    assert said == [
        f"near, 96x64, rightward ({spec.clip_id}): it arrived damaged; trying again (2 of 3)"
    ]
    assert (tmp_path / "clips" / record.file).stat().st_size == record.file_bytes


class GivingUp(Executor):
    """An executor whose connection is lost: what it has is cancelled."""

    def submit(self, *_: Any, **__: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.cancel()
        future.set_running_or_notify_cancel()
        return future


def test_a_lost_connection_is_told(tmp_path: Path) -> None:
    with pytest.raises(BatchError, match="was given back unrendered; is the scheduler still there"):
        render_on(GivingUp(), [SPEC], tmp_path)


def test_a_worker_of_another_version_ends_the_batch(
    here: Executor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(orders, "code_version", lambda: "0123")
    with pytest.raises(BatchError) as failed:
        render_on(here, seeded(1, 2), tmp_path)
    assert str(failed.value) == (
        f"a worker has version 0123 of the renderer, this machine {code_version()}: "
        "install the same Ocularist on both and start the worker again"
    )


class Elsewhere(ThreadPoolExecutor):
    """A machine that has no file at the paths that an order names."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        spec = {**args[0], "iris_file": f"/elsewhere{args[0]['iris_file']}"}
        return super().submit(fn, spec, *args[1:], **kwargs)


@pytest.fixture
def with_iris(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ClipSpec:
    monkeypatch.setenv("OCULARIST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("OCULARIST_TEST_FOLDER", str(tmp_path))
    path = tmp_path / "anna.npz"
    path.write_bytes(b"an iris")
    sha256 = hashlib.sha256(b"an iris").hexdigest()
    return replace(SPEC, iris_file=str(path), iris_sha256=sha256)


def test_files_that_a_worker_lacks_are_sent_once(
    with_iris: ClipSpec, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(HERE)
    import farm_orders

    used: list[Path] = []

    def make(spec: ClipSpec, _with_flip: bool) -> dict[str, Any]:
        used.append(Path(spec.iris_file))
        return farm_orders.fill(spec.to_dict(), "", contents={})

    monkeypatch.setattr(orders, "_make", make)
    sent: list[list[str]] = []
    fill = orders.fill_order

    def fill_and_note(spec: Any, version: str, *, contents: Any, **choices: bool) -> Any:
        sent.append(list(contents))
        return fill(spec, version, contents=contents, **choices)

    monkeypatch.setattr(farm, "fill_order", fill_and_note)
    specs = [with_iris, replace(with_iris, pupil_mm=3.0)]
    with Elsewhere(1) as executor:
        for number, spec in enumerate(specs):
            (record,) = render_on(executor, [spec], tmp_path / f"clips{number}")
            assert record.clip_spec == spec  # our path, not the worker's
    assert sent == [[], ["iris_file"], []]
    assert [path.read_bytes() for path in used] == [b"an iris"] * 2
    assert {path.parent for path in used} == {tmp_path / "cache" / "inputs"}
    assert used[0].suffix == ".npz"
    assert used[0].parent.stat().st_mode & 0o077 == 0


def test_a_file_that_changed_is_not_sent(with_iris: ClipSpec, tmp_path: Path) -> None:
    Path(with_iris.iris_file).write_bytes(b"another iris")
    with Elsewhere(1) as executor, pytest.raises(BatchError) as failed:
        render_on(executor, [with_iris], tmp_path)
    assert "anna.npz: changed since the clip was named (SHA-256 " in str(failed.value)


def test_a_kept_file_that_was_damaged_is_asked_for_again(
    with_iris: ClipSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        orders, "_make", lambda spec, _flip: {"data": Path(spec.iris_file).read_bytes()}
    )
    spec = with_iris.to_dict() | {"iris_file": "/elsewhere/anna.npz"}
    sent = {"iris_file": b"an iris"}
    assert orders.fill_order(spec, code_version(), contents={}) == {"wanted": ["iris_file"]}
    assert orders.fill_order(spec, code_version(), contents=sent) == {"data": b"an iris"}
    assert orders.fill_order(spec, code_version(), contents={}) == {"data": b"an iris"}
    (kept,) = (cache_folder() / "inputs").iterdir()
    kept.write_bytes(b"cut")
    assert orders.fill_order(spec, code_version(), contents={}) == {"wanted": ["iris_file"]}


def test_an_error_says_on_which_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_spec: ClipSpec, _with_flip: bool) -> None:
        raise RuntimeError("no OpenGL 4.3")

    monkeypatch.setattr(orders, "_make", fail)
    with pytest.raises(RuntimeError) as failed:
        orders.fill_order(SPEC.to_dict(), code_version(), contents={})
    assert failed.value.__notes__ == [f"on {socket.gethostname()}"]


def test_the_choice_about_flip_reaches_the_worker(
    here: Executor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[bool] = []

    def fail(_spec: ClipSpec, with_flip: bool) -> None:
        asked.append(with_flip)
        raise RuntimeError("enough")

    monkeypatch.setattr(orders, "_make", fail)
    for with_flip in (True, False):
        with pytest.raises(BatchError, match="enough"):
            render_on(here, [SPEC], tmp_path, with_flip=with_flip)
    assert asked == [True, False]
