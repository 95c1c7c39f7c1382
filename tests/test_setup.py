"""The set-up: what it says where it cannot install, that it runs once, what the lock files hold."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
TOOLS = ("bash", "awk", "cat", "cut", "dirname", "env", "grep", "head", "mkdir", "sed")
TOOLS += ("sha256sum", "tail", "tee", "tr")
LOCKS = ("requirements.lock", "requirements-test.lock")


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a folder with what the set-up reads, and ``bin`` with the few programs it may find."""
    shutil.copytree(ROOT / "deploy", tmp_path / "deploy")
    for name in ("pyproject.toml", *LOCKS):
        shutil.copy(ROOT / name, tmp_path)
    programs = tmp_path / "bin"
    programs.mkdir()
    for tool in TOOLS:
        (programs / tool).symlink_to(shutil.which(tool) or tool)
    # The Python that made our virtual environment: it can surely make one.
    (programs / "python3").symlink_to(getattr(sys, "_base_executable", sys.executable))
    return tmp_path


def program(checkout: Path, name: str, script: str) -> None:
    path = checkout / "bin" / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def set_up(checkout: Path, purpose: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [checkout / "deploy" / "setup", purpose],
        env={"PATH": str(checkout / "bin"), **environment},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )


NO_GL = {"LIBGL_DRIVERS_PATH": "/nonexistent", "__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}


def test_without_root_it_says_what_is_missing_and_how_to_install_it(checkout: Path) -> None:
    program(checkout, "id", "echo 1000")
    program(checkout, "apt-get", "exit 1")
    done = set_up(checkout, "study", **NO_GL)
    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        "",
        "Could not install: libegl1 libgl1 libgl1-mesa-dri",
        "That needs root, or sudo, and there is neither here.",
        "By hand, as root:",
        "",
        "    apt-get update && apt-get install -y libegl1 libgl1 libgl1-mesa-dri",
        "",
        "Then run make study again.",
    ]


def test_without_apt_the_tests_browser_is_named(checkout: Path) -> None:
    program(checkout, "id", "echo 0")
    done = set_up(checkout, "test")
    assert done.returncode == 1
    assert "Could not install: chromium\nThere is no apt-get here" in done.stderr


def test_without_root_one_line_names_what_the_long_tests_lack(checkout: Path) -> None:
    program(checkout, "id", "echo 1000")
    done = set_up(checkout, "test-long")
    assert done.returncode == 1
    [line] = [line for line in done.stderr.splitlines() if line.startswith("Could not install: ")]
    browsers = {"chromium", "firefox-esr", "chromium-driver", "webkit2gtk-driver", "xvfb"}
    assert browsers | {"r-cran-ordinal"} <= set(line.split())
    assert done.stderr.endswith("Then run make test-long again.\n")


def test_with_root_it_updates_and_installs_only_what_is_missing(checkout: Path) -> None:
    program(checkout, "id", "echo 0")
    program(checkout, "apt-get", f'echo "$@" >> {checkout}/asked')
    done = set_up(checkout, "test")
    asked = (checkout / "asked").read_text().splitlines()
    assert [line.split()[1] for line in asked] == ["update", "install"]
    assert asked[1].split()[-1] == "chromium"
    assert "libegl1" not in asked[1]
    # This apt-get did nothing, and that is noticed.
    assert done.returncode == 1
    assert "apt-get ran, but this machine still does without them." in done.stderr


def test_what_apt_said_is_shown_when_it_fails(checkout: Path) -> None:
    program(checkout, "id", "echo 0")
    program(checkout, "apt-get", 'echo "E: no route to the mirror" >&2; exit 100')
    done = set_up(checkout, "test")
    assert done.returncode == 1
    assert "E: no route to the mirror\n" in done.stderr
    assert "apt-get failed; its words are above, all of them in out/setup.log." in done.stderr


def test_a_second_run_does_nothing(checkout: Path) -> None:
    environment = checkout / ".venv" / "bin"
    environment.mkdir(parents=True)
    (environment / "python").symlink_to(sys.executable)
    (environment / "ocularist").symlink_to(sys.executable)
    made_from = f"{checkout}\n".encode()
    made_from += b"".join((checkout / name).read_bytes() for name in (LOCKS[0], "pyproject.toml"))
    stamp = checkout / ".venv" / "installed-study"
    stamp.write_text(hashlib.sha256(made_from).hexdigest() + "\n")
    done = set_up(checkout, "study")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert not (checkout / "out" / "setup.log").exists()


def test_an_unknown_purpose_is_refused(checkout: Path) -> None:
    done = set_up(checkout, "studdy")
    assert done.returncode == 2
    assert (
        done.stderr == 'deploy/setup: unknown purpose "studdy"; choose study, test or test-long\n'
    )


def locked(name: str) -> dict[str, str]:
    """Return package -> the text of its entry."""
    text = (ROOT / name).read_text(encoding="utf-8")
    entries = re.split(r"^(?=[a-z0-9])", text, flags=re.MULTILINE)
    return {re.split(r"[=\s]", entry)[0]: entry for entry in entries if entry.strip()}


@pytest.mark.parametrize("name", LOCKS)
def test_every_locked_package_has_a_version_and_hashes_and_no_address(name: str) -> None:
    for package, entry in locked(name).items():
        assert re.match(rf"{re.escape(package)}==\S+ ", entry), package
        assert "--hash=sha256:" in entry, package
        assert "://" not in entry, package


def test_the_lock_files_hold_what_the_project_names() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    run, test = locked(LOCKS[0]), locked(LOCKS[1])

    def names(requirements: list[str]) -> set[str]:
        return {re.split(r"[<>=!~\[ ]", requirement)[0].lower() for requirement in requirements}

    wanted = names(project["project"]["dependencies"]) | names(project["build-system"]["requires"])
    wanted |= names(project["project"]["optional-dependencies"]["characters"])
    assert wanted <= set(run)
    assert names(project["dependency-groups"]["test"]) <= set(run) | set(test)
    assert set(run) & set(test) == set()
    assert "torch" not in run  # anny comes without what it depends on


def test_make_lists_its_targets() -> None:
    done = subprocess.run(
        ["make", "-s", "-C", str(ROOT), "help"],
        env={"PATH": os.environ["PATH"]},
        capture_output=True,
        text=True,
        check=True,
    )
    targets = [line.split()[0] for line in done.stdout.splitlines()]
    assert targets == [
        "help",
        "study",
        "test",
        "test-long",
        "test-fresh",
        "pictures",
        "lock",
        "clean",
    ]
