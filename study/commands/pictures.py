"""Pictures that a study's clips are made from, looked at before any work starts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from study.design.definition import StudyDefinition


def check_pictures(definition: StudyDefinition) -> None:
    """Raise ValueError, naming the file, when the study's surroundings cannot light a scene."""
    scene = definition.scene
    if scene.environment == "image":
        from renderer.park.image import read_environment

        read_environment(Path(scene.environment_file))
