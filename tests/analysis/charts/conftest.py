"""What the tests of charts share: one small study with catch pairs and costs, and its figures."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from analysis.charts import CHARTS
from analysis.charts.material import Material
from analysis.costs.cost import Costs
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import tables_from

PAIRS = (("high", "ultra"), ("ultra", "low"), ("ultra", "ultra"))


@pytest.fixture(scope="session")
def material() -> Material:
    """Return a simulated study of 14 people at three distances, with catch pairs and costs."""
    clips = {
        f"{distance}-{left}-{right}": Stimulus(distance, POPULATION.iris_px[distance], left, right)
        for distance in ("near", "medium", "far")
        for left, right in PAIRS
    }
    frames = simulate_tables(
        clips, np.random.default_rng(3), participants=14, spoilers={0: "straight-liner"}
    )
    tables = tables_from(frames, source="small")
    rows = [
        {"renderer": "llvmpipe", "size": "640x360", "eyes": 2, "distance": distance}
        | {"iris_px": 1.0, "lod": lod, "ms_median": ms, "ms_mad": 1.0, "n": 9}
        for distance in ("near", "medium", "far")
        for lod, ms in (("low", 60.0), ("high", 150.0), ("ultra", 300.0))
    ]
    return Material(tables, Costs(pd.DataFrame(rows), "2 eyes, 640x360 pixels, llvmpipe"))


@pytest.fixture(scope="session")
def drawn_small(material: Material) -> dict[str, Figure]:
    """Return every chart of the small study, drawn once."""
    return {chart.name: chart.draw(material) for chart in CHARTS}


@pytest.fixture(scope="session")
def texts_of() -> Callable[[Figure], list[str]]:
    """Return what reads all texts of a figure."""

    def read(figure: Figure) -> list[str]:
        return [text.get_text() for text in figure.findobj(Text) if text.get_text()]

    return read
