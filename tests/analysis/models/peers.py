"""R's ``ordinal`` as a peer: run where R and the package are installed, else the tests say so."""

from __future__ import annotations

import io
import shutil
import subprocess
from functools import cache

import pandas as pd
import pytest


@cache
def lacks_r() -> str:
    """Return why R's ordinal cannot be asked, or nothing."""
    if shutil.which("Rscript") is None:
        return "R is not installed; make test-long installs r-cran-ordinal"
    trial = subprocess.run(
        ["Rscript", "-e", "library(ordinal)"], capture_output=True, text=True, check=False
    )
    return (
        "" if trial.returncode == 0 else "R lacks ordinal; make test-long installs r-cran-ordinal"
    )


def ask_r(script: str) -> pd.DataFrame:
    """Run a script that writes one CSV table to its output; the test fails without R."""
    if reason := lacks_r():
        pytest.fail(reason)
    done = subprocess.run(
        ["Rscript", "-e", f"suppressMessages(library(ordinal))\n{script}"],
        capture_output=True,
        text=True,
        check=True,
    )
    return pd.read_csv(io.StringIO(done.stdout))
