"""The frame source that uses GL: one context, one scene kept from clip to clip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from renderer.clip import ClipSpec
from renderer.crowd.group import GroupRenderer
from renderer.frame.frame import Frame, FrameRenderer
from renderer.frame.view_passes import PASSES
from renderer.gl.context import create_context, identify
from renderer.scene import Scene, scene_key


class Studio:
    """Render clips one after the other in this process; close it to give the context back."""

    def __init__(self) -> None:
        self.gl = create_context()
        identity = identify(self.gl)
        self.gl_renderer = identity.renderer
        self.gl_version = identity.version
        self._scene: Scene | None = None

    def renderer(
        self,
        spec: ClipSpec,
        *,
        wireframe: bool = False,
        eyes: tuple[int, ...] = (0, 1),
        until: str = PASSES[-1],
    ) -> FrameRenderer:
        """Return a renderer of one clip's frames, in the last clip's scene where it fits.

        The other arguments are those of ``FrameRenderer``.
        """
        renderer = FrameRenderer(
            self.gl, spec, scene=self._scene, wireframe=wireframe, eyes=eyes, until=until
        )
        self._scene = renderer.scene
        return renderer

    def group_renderer(self, spec: ClipSpec) -> GroupRenderer:
        """Return a renderer of the group view, in the last clip's surroundings where they fit."""
        is_same = self._scene is not None and self._scene.key[0] == scene_key(spec)[0]
        around = self._scene.surroundings if self._scene and is_same else None
        return GroupRenderer(self.gl, spec, surroundings=around)

    def frames(self, spec: ClipSpec, numbers: Sequence[int] | None = None) -> Iterator[Frame]:
        """Yield the clip's frames, or those with these numbers, in order."""
        renderer = self.renderer(spec)
        for number in range(spec.frame_count) if numbers is None else numbers:
            yield renderer.render_number(number)

    def close(self) -> None:
        """Release the context and all that lives in it."""
        self._scene = None
        self.gl.release()
