"""All strips of the gallery. page.md says what to look at in each."""

from __future__ import annotations

from pathlib import Path

from renderer.gallery.certificate import certificate_strips
from renderer.gallery.photograph import PHOTOGRAPH
from renderer.gallery.scenes import SCENES
from renderer.gallery.strips import STRIPS, Strip


def gallery_strips(certificate: Path) -> tuple[Strip, ...]:
    """Return the strips; ``certificate`` is a folder of ``ocularist certify``, which may be empty.

    The strips that share a scene stand together.
    """
    return (*STRIPS, PHOTOGRAPH, *SCENES, *certificate_strips(certificate))
