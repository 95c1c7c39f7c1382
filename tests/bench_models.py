"""Time the mixed ordinal model on 10 000, 100 000 and 1 000 000 simulated ratings.

    python tests/bench_models.py [--with-r]

100 ratings per person, 16 cells on either side, one random effect. With --with-r, R's clmm2 (by
Laplace) and clmm fit the smallest of them in the same run, where R and its package are installed.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from analysis.models.counts import count_answers
from analysis.models.fitting import fit
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Linear

CELLS, EACH = 16, 100
TAU = np.array([-1.35, -0.25, 0.85, 1.85])
SCRIPT = """
suppressMessages(library(ordinal))
d <- read.csv("{path}")
for (name in c("y", "cell", "right", "person")) d[[name]] <- factor(d[[name]])
t1 <- system.time(f <- clmm2(y ~ cell + right, random = person, data = d, link = "probit"))[3]
t2 <- system.time(g <- clmm(y ~ cell + right + (1 | person), data = d, link = "probit"))[3]
cat(sprintf("R clmm2 (Laplace)  %8.2f s  log-likelihood %.4f\\n", t1, as.numeric(logLik(f))))
cat(sprintf("R clmm (Laplace)   %8.2f s  log-likelihood %.4f\\n", t2, as.numeric(logLik(g))))
"""


def draw(people: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return person, stimulus (cell + 16 if on the right) and answer (0 to 4) of every rating."""
    realism = np.append(0.0, rng.normal(0, 0.7, CELLS - 1))
    who = np.repeat(np.arange(people), EACH)
    what = rng.integers(2 * CELLS, size=who.size)
    percept = realism[what % CELLS] + 0.05 * (what >= CELLS)
    percept = percept + rng.normal(0, 0.45, people)[who] + rng.standard_normal(who.size)
    return who, what, np.searchsorted(TAU, percept)


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--with-r", action="store_true")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    design = np.column_stack([np.tile(np.eye(CELLS), (2, 1))[:, 1:], np.repeat([0.0, 1.0], CELLS)])
    names = (*(f"cell {k}" for k in range(1, CELLS)), "right")
    model = OrdinalModel(Linear(design, names), effects=(LENIENCY,))
    print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
    for people in (100, 1000, 10_000):
        who, what, answer = draw(people, np.random.default_rng(people))
        times = []
        for _ in range(arguments.repeats):
            start = time.perf_counter()
            counts = count_answers(who, what, answer, shape=(people, 2 * CELLS, 5))
            found = fit(model, counts)
            times.append(time.perf_counter() - start)
        print(
            f"{who.size:9,} ratings  median {statistics.median(times):6.2f} s "
            f"(fastest {min(times):.2f}, slowest {max(times):.2f})  "
            f"log-likelihood {found.log_likelihood:.4f}  {found.grid.counts[0]} nodes",
            flush=True,
        )
        if people == 100 and arguments.with_r:
            time_r(who, what, answer)


def time_r(who: np.ndarray, what: np.ndarray, answer: np.ndarray) -> None:
    """Let R fit the same ratings."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "ratings.csv"
        rows = np.column_stack([answer, what % CELLS, what >= CELLS, who]).astype(int)
        np.savetxt(path, rows, fmt="%d", delimiter=",", header="y,cell,right,person", comments="")
        done = subprocess.run(
            ["Rscript", "-e", SCRIPT.format(path=path)], capture_output=True, text=True, check=False
        )
    print((done.stdout or done.stderr).rstrip(), flush=True)


if __name__ == "__main__":
    main()
