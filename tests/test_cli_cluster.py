"""A real Dask cluster on this machine: two processes without our folder, deaths, strangers."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import dask
import pytest
from distributed import Client, LocalCluster

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.manifest import read_manifest
from renderer.production import farm
from renderer.production.farm import BatchError, render_on
from study.cli import main
from study.commands import cluster as clusters
from study.commands.cluster import cluster
from study.commands.errors import CommandError

SPEC = ClipSpec(
    left=Detail.uniform("low"),
    right=Detail.uniform("ultra"),
    distance="near",
    width=96,
    height=64,
    duration_s=0.2,
    fps=10,
)
RENDERER_TESTS = Path(__file__).parent / "renderer" / "production"


@contextmanager
def local_cluster(workers: int) -> Iterator[LocalCluster]:
    # Killed workers come back slowly on a loaded machine; Dask gives them up after 15 s.
    patient = dask.config.set({"distributed.deploy.lost-worker-timeout": "300s"})
    with (
        patient,
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            silence_logs=60,  # what a killed worker makes it say is meant to happen here
        ) as started,
    ):
        yield started


@pytest.fixture(scope="module")
def folder_of_orders(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("orders")


@pytest.fixture(scope="module")
def cluster_of_two(folder_of_orders: Path) -> Iterator[LocalCluster]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(RENDERER_TESTS)
        patch.setenv("OCULARIST_TEST_FOLDER", str(folder_of_orders))
        with local_cluster(2) as started:
            yield started


@pytest.fixture
def address(cluster_of_two: LocalCluster) -> str:
    """The cluster's address once both workers are there: a test before may have killed them."""
    with Client(cluster_of_two.scheduler_address) as client:
        client.wait_for_workers(2, timeout=300)
    return str(cluster_of_two.scheduler_address)


@pytest.fixture
def fake(
    folder_of_orders: Path, address: str, monkeypatch: pytest.MonkeyPatch
) -> Iterator[ModuleType]:
    """Let orders be filled by farm_orders, which the cluster's processes can import too."""
    assert address
    import farm_orders

    monkeypatch.setattr(farm, "fill_order", farm_orders.fill)
    yield farm_orders
    (folder_of_orders / "orders.txt").unlink(missing_ok=True)


def silent(line: str) -> None:
    raise AssertionError(f"nothing to say, but: {line}")


def test_a_killed_worker_costs_only_its_clip(
    fake: ModuleType, address: str, tmp_path: Path
) -> None:
    specs = [replace(SPEC, iris_seed=seed) for seed in (1, fake.ONCE, 2, 3)]
    heard: list[int] = []
    with cluster(address, say=silent) as executor:
        records = render_on(executor, specs, tmp_path, progress=heard.append, say=silent)
    assert [record.clip_spec for record in records] == specs
    assert sorted(read_manifest(tmp_path).clips) == sorted(spec.clip_id for spec in specs)
    assert sorted(set(fake.ordered())) == [1, 2, 3, fake.ONCE]
    assert fake.ordered().count(fake.ONCE) == 2
    assert heard == [0, 1, 2, 3, 4]


def test_a_clip_that_kills_every_worker_is_given_up(
    fake: ModuleType, address: str, tmp_path: Path
) -> None:
    specs = [replace(SPEC, iris_seed=seed) for seed in (fake.ALWAYS, fake.FAULTY)]
    with cluster(address, say=silent) as executor, pytest.raises(BatchError) as failed:
        render_on(executor, specs, tmp_path, say=silent)
    lines = sorted(str(failed.value).splitlines())
    assert len(lines) == 2
    assert any(f"({specs[1].clip_id}): the iris is on holiday" in line for line in lines)
    assert any("all those workers died while running it" in line for line in lines)


def test_another_version_is_told_before_any_work(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("renderer.sources.code_version", lambda: "0123")
    with pytest.raises(CommandError) as failed, cluster(address, say=silent):
        raise AssertionError("begun")
    lines = str(failed.value).splitlines()
    assert lines  # one per worker that is there now; the scheduler lives in this process
    end = " of the renderer, this machine 0123; install the same Ocularist there"
    assert all(line.startswith("tcp://127.0.0.1:") and line.endswith(end) for line in lines)


def test_a_machine_without_ocularist_is_named(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(clusters, "_VERSION", "__import__('renderer_that_is_not_there')")
    with pytest.raises(CommandError) as failed, cluster(address, say=silent):
        raise AssertionError("begun")
    assert (
        f"{address} has no Ocularist that can be imported (No module named "
        "'renderer_that_is_not_there'); install the same Ocularist there"
    ) in str(failed.value).splitlines()


def test_a_scheduler_that_goes_while_it_is_waited_for_is_told(tmp_path: Path) -> None:
    said: list[str] = []

    def go(started: LocalCluster) -> None:
        while not started.scheduler.tasks:  # until the clip is ordered
            time.sleep(0.01)
        started.close()

    def render(address: str) -> None:
        with cluster(address, say=said.append) as executor:
            render_on(executor, [SPEC], tmp_path)

    with local_cluster(0) as started:
        address = started.scheduler_address
        thread = threading.Thread(target=go, args=[started])
        thread.start()
        with pytest.raises(BatchError, match="is the scheduler still there"):
            render(address)
        thread.join()
    assert said == [f"{address} has no workers yet; start some: dask worker {address} --nthreads 1"]


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as free:
        return int(free.getsockname()[1])


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("tcp://127.0.0.1:{port}", "no Dask scheduler answers there"),
        ("render-farm", "no address (missing port number in address 'render-farm')"),
        ("http://127.0.0.1:1", "no address (unknown address scheme 'http'"),
    ],
)
def test_an_address_where_no_scheduler_listens_is_one_line(
    address: str,
    words: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(clusters, "ANSWER_S", 0.5)
    address = address.format(port=free_port())
    assert main(["render", "--scheduler", address, "--out", str(tmp_path / "clips")]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"ocularist render: --scheduler {address}: {words}")
    assert len(err.splitlines()) == 1
    assert not (tmp_path / "clips").exists()
