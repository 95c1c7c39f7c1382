"""One GL context for all renderer tests: opening one costs a third of a second."""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import pytest

from renderer.context import create_context


@pytest.fixture(scope="session")
def gl() -> Iterator[moderngl.Context]:
    context = create_context()
    yield context
    context.release()
