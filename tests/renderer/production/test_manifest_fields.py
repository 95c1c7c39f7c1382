"""The manifest: older ones are read, masters are looked for."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.manifest import MANIFEST_NAME, ClipRecord, Manifest, read_manifest, write_manifest

SPEC = ClipSpec(left=Detail(), right=Detail())
RECORD = ClipRecord(
    clip_id=SPEC.clip_id,
    spec=SPEC.to_dict(),
    file="a.mp4",
    file_sha256="0",
    file_bytes=3,
    raw_sha256="1",
    frame_count=1,
    width=64,
    height=64,
    fps=30,
    iris_px=[[1.0, 1.0]],
    visible_px=[[1, 1]],
    psnr_db=[40.0, 41.0],
    ssim=[0.99, 0.98],
    frame_ms_median=1.0,
    render_s=1.0,
    gl_renderer="x",
    gl_version="y",
    code_version="z",
)
SINCE_2 = [
    "flip_rectangle",
    "flip_encoding",
    "flip_lods",
    "flip_note",
    "crf",
    "max_bytes",
    "missed",
    "master",
]


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    told = replace(
        RECORD, flip_encoding=[0.01, 0.02], flip_lods=[0.2, 0.3], missed=["too large"], crf=26.0
    )
    write_manifest(Manifest(clips={told.clip_id: told}), tmp_path)
    assert read_manifest(tmp_path).clips == {told.clip_id: told}


def test_a_manifest_of_schema_1_says_nothing_of_flip(tmp_path: Path) -> None:
    write_manifest(Manifest(clips={RECORD.clip_id: RECORD}), tmp_path)
    path = tmp_path / MANIFEST_NAME
    data = json.loads(path.read_text())
    old = [
        {key: value for key, value in row.items() if key not in SINCE_2} for row in data["clips"]
    ]
    path.write_text(json.dumps({"schema": 1, "clips": old}))
    assert read_manifest(tmp_path).clips == {RECORD.clip_id: RECORD}
    assert RECORD.flip_encoding is None
    path.write_text(json.dumps({"schema": 3, "clips": old}))
    with pytest.raises(ValueError, match=r"not a manifest of schema 2 \(schema 3\)"):
        read_manifest(tmp_path)


def test_a_master_counts_only_when_it_is_whole(tmp_path: Path) -> None:
    assert not RECORD.has_master(tmp_path)
    told = replace(RECORD, master={"file": "a.master.mkv", "sha256": "2", "bytes": 4})
    assert not told.has_master(tmp_path)
    (tmp_path / "a.master.mkv").write_bytes(b"cut")
    assert not told.has_master(tmp_path)
    (tmp_path / "a.master.mkv").write_bytes(b"whole"[:4])
    assert told.has_master(tmp_path)
