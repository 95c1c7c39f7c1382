"""Mitsuba 3, the path tracer that we compare with: found, chosen, and told what it is.

Optional: only ``ocularist certify`` needs it.
"""

from __future__ import annotations

import importlib
import importlib.util
import subprocess
import sys
from functools import cache
from typing import Any, Final

INSTALL: Final = 'needs {names}, not installed here; pip install "ocularist[certify]"'
SAFE_VARIANT: Final = "scalar_rgb"
FAST_VARIANT: Final = "llvm_ad_rgb"  # about seven times as fast, where LLVM is new enough
PROBE_S: Final = 60.0
# With an LLVM that does not know the processor the compiler aborts the whole process: only a
# process of its own can find out.
_PROBE: Final = """
import mitsuba
mitsuba.set_variant("llvm_ad_rgb")
ball = {"type": "sphere", "bsdf": {"type": "dielectric"}}
scene = {"type": "scene", "integrator": {"type": "path"}, "sky": {"type": "constant"}, "ball": ball,
         "sensor": {"type": "perspective", "film": {"type": "hdrfilm", "width": 8, "height": 8}}}
print(float(mitsuba.render(mitsuba.load_dict(scene), spp=4).array[0]))
"""


def check_installed() -> None:
    """Raise RuntimeError that says what to install unless path tracer and metric are there."""
    missing = [
        package
        for package, module in (("mitsuba", "mitsuba"), ("flip-evaluator", "flip_evaluator"))
        if importlib.util.find_spec(module) is None
    ]
    if missing:
        raise RuntimeError(INSTALL.format(names=" and ".join(missing)))


def path_tracer(variant: str = SAFE_VARIANT) -> Any:
    """Return the module ``mitsuba`` with a variant chosen."""
    check_installed()
    mitsuba: Any = importlib.import_module("mitsuba")
    mitsuba.set_variant(variant)
    mitsuba.logger().clear_appenders()  # no progress bars between our lines
    return mitsuba


@cache
def best_variant() -> str:
    """Return the fast variant where it works here, else the safe one."""
    try:
        probe = subprocess.run(
            [sys.executable, "-c", _PROBE], capture_output=True, timeout=PROBE_S, check=False
        )
    except subprocess.TimeoutExpired:
        return SAFE_VARIANT
    return FAST_VARIANT if probe.returncode == 0 else SAFE_VARIANT
