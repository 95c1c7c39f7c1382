"""The shelf of rendered clips: which file shows a trial, under a name that says nothing.

A clip's public name is the SHA-256 of its file. It tells nothing of LoDs, distance or study, lets
a browser check what arrived, and changes when the clip is rendered anew: browsers may keep what
they have for ever.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from stat import S_ISREG
from typing import Any

from renderer.manifest import MANIFEST_NAME, ClipRecord, Manifest, read_manifest


@dataclass
class ClipShelf:
    """The clips of a media folder; its manifest is read again whenever it has changed."""

    folder: Path
    _stamp: tuple[int, int] | None = None
    _manifest: Manifest = field(default_factory=Manifest)
    _by_name: dict[str, ClipRecord] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def record(self, clip_id: str) -> ClipRecord | None:
        """Return the record of a clip whose whole file is there, or None."""
        self._refresh()
        record = self._manifest.clips.get(clip_id)
        return record if record is not None and self._is_whole(record) else None

    def records(self, clip_ids: Iterable[str]) -> list[ClipRecord]:
        """Return the records of those of many clips whose whole files are there, in order."""
        self._refresh()
        found = (self._manifest.clips.get(clip_id) for clip_id in clip_ids)
        return [record for record in found if record is not None and self._is_whole(record)]

    def file(self, name: str) -> Path | None:
        """Return the file of a public name, or None."""
        self._refresh()
        record = self._by_name.get(name)
        return self.folder / record.file if record and self._is_whole(record) else None

    def _is_whole(self, record: ClipRecord) -> bool:
        try:
            found = (self.folder / record.file).stat()
        except OSError:
            return False
        return S_ISREG(found.st_mode) and found.st_size == record.file_bytes

    def _refresh(self) -> None:
        try:
            found = (self.folder / MANIFEST_NAME).stat()
        except FileNotFoundError:
            return
        stamp = (found.st_mtime_ns, found.st_ino)
        with self._lock:
            if stamp != self._stamp:
                self._manifest = read_manifest(self.folder)
                self._by_name = {public_name(r): r for r in self._manifest.clips.values()}
                self._stamp = stamp


def public_name(record: ClipRecord) -> str:
    """Return the name under which the site serves a clip."""
    return record.file_sha256


def clip_url(record: ClipRecord) -> str:
    """Return the address of a clip."""
    return f"/clips/{public_name(record)}.mp4"


def to_preload(record: ClipRecord) -> dict[str, Any]:
    """Return what the preloader needs to know: where the clip is and how long."""
    return {"url": clip_url(record), "bytes": record.file_bytes}


def to_expect(record: ClipRecord) -> dict[str, Any]:
    """Return what the record of a faultless play of this clip holds."""
    return {
        "expected_frames": record.frame_count,
        "expected_fps": record.fps,
        "expected_sha256": record.file_sha256,
    }
