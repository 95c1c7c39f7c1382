"""The manifest beside the clips: what was rendered, from what, with what, and how well encoded.

Pure apart from reading and writing its own file; it knows neither GL nor study.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

from renderer.atomic_file import write_atomically
from renderer.clip import ClipSpec
from renderer.sources import code_version

MANIFEST_NAME: Final = "manifest.json"
SCHEMA: Final = 2
READABLE: Final = (1, 2)  # 1 lacks what has a default below


@dataclass(frozen=True, kw_only=True)
class ClipRecord:
    """One rendered clip.

    ``iris_px`` is the iris's diameter on the picture per frame (frames, eyes left and right);
    ``visible_px`` each eye's unoccluded pixels per frame, in the same shape.
    ``lod_places`` is, where eyes switch their LoD, each eye's place between the steps of the spec's
    ``lod_policy`` per frame: 1.25 is step 1 (from 0, the coarsest) with a quarter of step 2. It is
    empty where both eyes keep the LoDs of the spec.
    ``raw_sha256`` is taken over the frames' RGB bytes in order, before encoding.

    How well it is encoded, inside the eyes, left and right: ``psnr_db``, ``ssim`` and mean FLIP (0
    to 1) of raw against decoded, in the whole rectangle (``flip_rectangle``) and at the pixels in
    which the clip's LoDs differ (``flip_encoding``); there too the FLIP of one LoD against the
    other (``flip_lods``). ``flip_share`` is the former's sum as a share of the latter's, and
    ``flip_floor`` what 8 bits of 4:2:0 alone would have of it in the middle frame. ``flip_note``
    says why any is null. ``crf`` is x264's constant rate factor, ``max_bytes`` the bound on the
    file; ``missed`` has a sentence per bound that does not hold. ``master`` has ``file``,
    ``sha256`` and ``bytes`` of the frames without loss, or is null.
    """

    clip_id: str
    spec: dict[str, Any]
    file: str
    file_sha256: str
    file_bytes: int
    raw_sha256: str
    frame_count: int
    width: int
    height: int
    fps: int
    iris_px: list[list[float]]
    visible_px: list[list[int]]
    psnr_db: list[float]
    ssim: list[float]
    frame_ms_median: float
    render_s: float
    gl_renderer: str
    gl_version: str
    code_version: str
    lod_places: list[list[float]] = field(default_factory=list)
    flip_rectangle: list[float] | None = None
    flip_encoding: list[float] | None = None
    flip_lods: list[float] | None = None
    flip_share: float | None = None
    flip_floor: float | None = None
    flip_note: str = ""
    crf: float | None = None
    max_bytes: int | None = None
    missed: list[str] = field(default_factory=list)
    master: dict[str, Any] | None = None

    @property
    def clip_spec(self) -> ClipSpec:
        """The clip's spec as a ClipSpec."""
        return ClipSpec.from_dict(self.spec)

    def has_master(self, folder: Path) -> bool:
        """Say whether the clip's frames lie in the folder without loss, whole."""
        if self.master is None:
            return False
        path = folder / str(self.master["file"])
        return path.is_file() and path.stat().st_size == int(self.master["bytes"])


@dataclass(kw_only=True)
class Manifest:
    """All clips of one folder, by clip id."""

    clips: dict[str, ClipRecord] = field(default_factory=dict)

    def add(self, record: ClipRecord) -> None:
        """Add or replace one clip's record."""
        self.clips[record.clip_id] = record

    def current(self, clip_id: str, folder: Path) -> ClipRecord | None:
        """Return the record of a clip that is whole and made by this code version, or None."""
        record = self.clips.get(clip_id)
        if record is None or record.code_version != code_version():
            return None
        path = folder / record.file
        whole = path.is_file() and path.stat().st_size == record.file_bytes
        return record if whole else None


def read_manifest(folder: Path) -> Manifest:
    """Read ``manifest.json`` of a folder; an absent file is an empty manifest.

    Raises ValueError naming the file when it is not a manifest of this schema.
    """
    path = folder / MANIFEST_NAME
    if not path.exists():
        return Manifest()
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        if data["schema"] not in READABLE:
            raise ValueError(f"schema {data['schema']}")
        records = [ClipRecord(**row) for row in data["clips"]]
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(
            f"{path}: not a manifest of schema {SCHEMA} ({error}); "
            "move the file away and render again"
        ) from error
    return Manifest(clips={record.clip_id: record for record in records})


def write_manifest(manifest: Manifest, folder: Path) -> None:
    """Write ``manifest.json`` atomically: a reader sees the old file or the new one, whole."""
    data = {"schema": SCHEMA, "clips": [asdict(record) for record in manifest.clips.values()]}
    write_atomically(folder / MANIFEST_NAME, json.dumps(data, indent=1).encode())
