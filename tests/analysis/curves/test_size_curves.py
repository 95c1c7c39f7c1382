"""Psychometric curves: an independent library, closed forms, brute force, honest ends, recovery."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy.special import log_ndtr, ndtr, ndtri

from analysis.curves.along_sizes import curves_of
from analysis.curves.compared import against_best
from analysis.curves.curve import (
    ABOVE,
    BELOW,
    D_PRIME_1,
    HALFWAY,
    MARGIN,
    NOTICED,
    PREFERRED,
    RATED,
    curve_table,
    make_threshold,
    point_table,
    threshold_table,
)
from analysis.curves.law import SizeLaw
from analysis.curves.noticed import noticed_curves, noticed_law
from analysis.curves.shapes import Shape, Shaped
from analysis.curves.sizes import DEGREES, PIXELS, crossing, with_size
from analysis.decision.margins import DEFAULT
from analysis.models.combined import Beside, Scaled, Together
from analysis.models.predictors import Linear
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from

RANKS = {"low": 0.0, "medium": 1.0, "high": 2.0, "ultra": 3.0}
SIZES = (12.0, 24.0, 48.0, 96.0, 192.0, 350.0)


def answers(px: float, lod: str, words: dict[str, int], *, people: int = 50) -> pd.DataFrame:
    """Return trials of ``lod`` beside ultra with the given answers, spread over people."""
    noticed = [word for word, count in words.items() for _ in range(count)]
    return pd.DataFrame(
        {
            "participant": [f"p{i % people}" for i in range(len(noticed))],
            "is_practice": False,
            "distance": "any",
            "iris_px": px,
            "left_lod": lod,
            "right_lod": "ultra",
            "noticed": noticed,
        }
    )


def yes_and_no(share: float, count: int) -> dict[str, int]:
    yes = round(share * count)
    return {"yes": yes, "no": count - yes}


def along_probit(slope: float, middle: float, count: int) -> pd.DataFrame:
    """Return answers whose d' grows from 0 to 6 with log2 px, and equal pairs at 10 %."""
    criterion = -ndtri(0.1)
    parts = [answers(90.0, "ultra", yes_and_no(0.1, 4 * count))]
    for px in SIZES:
        d = 6.0 * ndtr((np.log2(px) - middle) * slope)
        parts.append(answers(px, "low", yes_and_no(float(ndtr(d - criterion)), count)))
    return pd.concat(parts, ignore_index=True)


def test_at_each_size_the_curve_agrees_with_a_probit_glm_of_another_library() -> None:
    rows = along_probit(0.9, 6.0, 400)
    (curve,) = noticed_curves(rows, PIXELS, np.random.default_rng(1), best="ultra", margins=DEFAULT)
    yes = (rows["noticed"] == "yes").astype(float)
    is_pair = rows["left_lod"] == "low"
    cells = pd.get_dummies(rows["iris_px"].where(is_pair, 0.0)).astype(float)
    link = sm.families.links.Probit()
    fitted = sm.GLM(yes, cells, family=sm.families.Binomial(link)).fit()
    for px in SIZES:
        at = int(np.abs(curve.sizes - px).argmin())
        assert curve.value[at] == pytest.approx(ndtr(fitted.params[px]), abs=0.02)
    assert curve.base[0] == pytest.approx(ndtr(fitted.params[0.0]), abs=0.01)


def test_thresholds_are_where_closed_forms_put_them() -> None:
    rows = along_probit(0.9, 6.0, 2000)
    (curve,) = noticed_curves(rows, PIXELS, np.random.default_rng(1), best="ultra", margins=DEFAULT)
    criterion = -ndtri(0.1)

    def size_of(d: float) -> float:
        return float(2.0 ** (6.0 + ndtri(d / 6.0) / 0.9))

    for name, wanted in (
        (D_PRIME_1, size_of(1.0)),
        (HALFWAY, size_of(criterion + ndtri(0.55))),
        (MARGIN, size_of(criterion + ndtri(0.35))),
    ):
        found = curve.threshold(name)
        assert found.size == pytest.approx(wanted, rel=0.04)
        assert found.low < wanted < found.high
        assert found.low < found.safe < found.size
    with pytest.raises(KeyError, match="no threshold one_jod of what was noticed"):
        curve.threshold("one_jod")


def test_the_likelihood_of_the_law_has_its_top_where_a_grid_search_finds_it() -> None:
    rows = against_best(along_probit(0.9, 6.0, 150), PIXELS, "ultra")
    law = noticed_law(rows, PIXELS, np.random.default_rng(1), best="ultra")
    assert isinstance(law, SizeLaw)
    tau, noise = law.answer_criteria(law.fit.parameters[None])
    x = np.array([np.log2(px) for px in SIZES])
    counts = rows[rows["lod"] == "low"].groupby("iris_px")["noticed"]
    yes = np.array([(own == "yes").sum() for _, own in counts])
    total = counts.size().to_numpy()

    def log_posterior(height: float, middle: float, width: float) -> float:
        z = np.exp(height) * ndtr((x - middle) / np.exp(width)) - tau[0, -1] / noise[0]
        log_prior = -0.5 * ((height - np.log(1.5)) ** 2 + ((middle - 6.5) / 2) ** 2)
        log_prior -= 0.5 * (width / 0.5) ** 2
        return float((yes * log_ndtr(z) + (total - yes) * log_ndtr(-z)).sum() + log_prior)

    grid = [
        (h, m, w)
        for h in np.linspace(0.8, 2.6, 25)
        for m in np.linspace(4.8, 7.2, 49)
        for w in np.linspace(-0.8, 0.8, 17)
    ]
    h, m, w = max(grid, key=lambda own: log_posterior(*own))
    brute = np.exp(h) * ndtr((x - m) / np.exp(w))
    seen = brute < 3.0  # beyond, all say yes and nothing more can be told
    fitted = law.difference("low", x)[0] / noise[0]
    assert np.abs(fitted - brute)[seen].max() < 0.12


def test_beyond_the_sizes_shown_nothing_is_said() -> None:
    rows = pd.concat(
        [
            answers(90.0, "ultra", yes_and_no(0.1, 400)),
            *(answers(px, "low", yes_and_no(0.99, 200)) for px in (100.0, 200.0)),
            *(answers(px, "high", yes_and_no(0.1, 200)) for px in (100.0, 200.0)),
            answers(100.0, "medium", yes_and_no(0.5, 200)),
        ],
        ignore_index=True,
    )
    low, high = sorted(
        noticed_curves(rows, PIXELS, np.random.default_rng(1), best="ultra", margins=DEFAULT),
        key=lambda curve: curve.lod == "high",
    )  # medium was shown at one size: it has no curve
    assert (low.lod, high.lod) == ("low", "high")
    assert low.shown == high.shown == pytest.approx((100.0, 200.0))
    below, above = low.threshold(MARGIN), high.threshold(MARGIN)
    assert (below.size, below.high, above.size, above.safe) == (0.0, 0.0, np.inf, np.inf)
    assert low.say(below) == "below 100\N{NO-BREAK SPACE}px (nearly all draws)"
    assert high.say(above) == "above 200\N{NO-BREAK SPACE}px (nearly all draws)"
    table = threshold_table([low, high]).set_index(["lod", "threshold"])
    assert table.loc[("low", MARGIN), ["size_is", "high_is"]].tolist() == [BELOW, BELOW]
    assert table.loc[("high", MARGIN), "size_is"] == ABOVE
    assert table["size"].isna().all()


def test_without_equal_pairs_a_share_of_yes_gives_no_curve() -> None:
    rows = along_probit(0.9, 6.0, 50)
    rows = rows[rows["left_lod"] == "low"]
    assert not noticed_curves(rows, PIXELS, np.random.default_rng(1), best="ultra", margins=DEFAULT)


def test_crossings_are_linear_between_sizes_and_infinite_outside() -> None:
    x = np.array([0.0, 1.0, 2.0])
    rows = np.array([[0.0, 0.5, 1.0], [0.8, 0.9, 1.0], [0.0, 0.1, 0.2], [0.0, 0.7, 0.7]])
    assert crossing(x, rows, 0.7).tolist() == pytest.approx([1.4, -np.inf, np.inf, 1.0])
    draws = np.vstack([np.repeat(rows[:1], 98, axis=0), rows[1:2], rows[2:3]])
    found = make_threshold(MARGIN, 0.7, x, value=rows[0], draws=draws, levels=0.7, confidence=0.95)
    assert (found.low, found.size, found.high) == pytest.approx((2**1.4,) * 3)


def test_sizes_are_taken_together_within_a_part_of_an_octave() -> None:
    rows = pd.DataFrame({"iris_px": [100.0, 101.0, 200.0, np.nan, 0.0]})
    sized = with_size(rows, PIXELS)
    assert len(sized) == 3
    assert sized["size"].nunique() == 2
    assert sized["size"].iloc[0] == pytest.approx(np.log2([100, 101]).mean())
    assert with_size(rows, DEGREES).empty


def test_sizes_beside_a_bins_edge_are_one() -> None:
    """51 and 52 pixels fall into two eighths of an octave; no curve runs along them."""
    near = pd.DataFrame({"iris_px": [51.0, 51.8, 52.4]})
    assert with_size(near, PIXELS)["size"].nunique() == 1
    apart = pd.DataFrame({"iris_px": [50.0, 56.0]})
    assert with_size(apart, PIXELS)["size"].nunique() == 2


def test_predictors_made_of_others_have_the_derivatives_of_differences() -> None:
    rng = np.random.default_rng(3)
    x = rng.uniform(3, 9, 8)

    def law(name: str, group: list[int]) -> Shaped:
        return Shaped(Shape(), x, np.array(group) == 0, name)

    own = Together(law("low", [0, 0, 0, -1, -1, 0, -1, -1]), law("high", [-1] * 3 + [0] * 5))
    beside = Together(law("low", [-1] * 8), law("high", [0, -1] * 4))
    plain = Linear(rng.normal(size=(8, 2)), ("p", "q"))
    signs = rng.choice([-1.0, 1.0], 8)
    model = Beside(Together(plain, Scaled(own, signs)), Together(plain, Scaled(beside, signs)))
    at = rng.normal(0.3, 0.4, len(model.names))
    at[[3, 6]] += 6.0
    steps = np.eye(len(at)) * 1e-6
    by_difference = [(model.eta(at + s) - model.eta(at - s)) / 2e-6 for s in steps]
    assert model.jacobian(at) == pytest.approx(np.column_stack(by_difference), abs=1e-7)
    assert (model.stimuli, len(model.kinds)) == (8, len(at))
    assert model.names[2] == "log_height:low"
    assert model.names[-1] == "contrast"


@pytest.fixture(scope="module")
def simulated() -> Tables:
    shown = {}
    for distance, px in (("macroscopic", 350.0), ("near", 160.0), ("medium", 40.0), ("far", 12.0)):
        for left, right in (("low", "ultra"), ("ultra", "low"), ("ultra", "ultra"), ("low", "low")):
            shown[f"{distance} {left} {right}"] = Stimulus(distance, px, left, right)
    frames = simulate_tables(shown, np.random.default_rng(4), participants=24)
    per_degree = dict(
        zip(frames["participants"]["participant"], [35.0, 45.0, 60.0] * 8, strict=True)
    )
    for table in ("ratings", "comparisons"):
        density = frames[table]["participant"].map(per_degree)
        frames[table]["iris_deg"] = frames[table]["iris_px"] / density
    return tables_from(frames)


def test_simulated_people_are_recovered_over_pixels_and_over_degrees(simulated: Tables) -> None:
    found = curves_of(simulated, np.random.default_rng(5), margins=DEFAULT, ranks=RANKS, experts={})
    assert found.notes == ()
    assert [curve.kind for curve in found.curves] == [NOTICED, PREFERRED, RATED] * 2
    noticed, rated = found.of(NOTICED)["low"], found.of(RATED)["low"]
    # Generator: d' = 3.8 Phi((x - 6.5) / .9), so d' = 1 at 6.5 - .57 = 5.93 octaves, 61 px.
    threshold = noticed.threshold(D_PRIME_1)
    assert threshold.low < 61.0 < threshold.high
    truth = {350.0: 1.85, 160.0: 1.30, 40.0: 0.85, 12.0: 0.25}
    for px, loss in truth.items():
        at = int(np.abs(rated.sizes - px).argmin())
        assert rated.low[at] - 0.15 < loss < rated.high[at] + 0.15
    degrees = found.of(NOTICED, DEGREES)["low"].threshold(D_PRIME_1)
    assert 61.0 / 60.0 < degrees.size < 61.0 / 35.0


def test_tables_of_curves_name_everything_that_was_fitted(simulated: Tables) -> None:
    found = curves_of(
        simulated, np.random.default_rng(5), margins=DEFAULT, ranks=RANKS, experts={}
    ).curves
    names = ["kind", "measure", "lod", "best"]
    table = curve_table(found)
    assert list(table) == [*names, "size", "value", "low", "high", "without_difference"]
    assert len(table) == 6 * 61
    assert (table["low"] <= table["high"]).all()
    points = point_table(found)
    assert list(points) == [*names, "size", "value", "low", "high", "answers"]
    assert points.loc[points["kind"] == NOTICED, "value"].between(0, 1).all()
    assert list(threshold_table(found))[:6] == [*names, "threshold", "level"]


def test_a_study_without_sizes_or_ranks_says_so(simulated: Tables) -> None:
    unsized = Tables(
        simulated.ratings.assign(iris_px=np.nan, iris_deg=np.nan),
        simulated.comparisons.assign(iris_px=np.nan, iris_deg=np.nan),
        simulated.participants,
    )
    rng = np.random.default_rng(5)
    found = curves_of(unsized, rng, margins=DEFAULT, ranks=RANKS, experts={})
    assert found.curves == ()
    assert found.notes[0] == "The size of the iris in pixels (iris_px) is not known."
    found = curves_of(simulated, rng, margins=DEFAULT, ranks={}, experts={})
    assert found.notes == ("No LoD has a rank: none counts as the best to compare with.",)
    near = simulated.ratings["distance"] == "near"
    compared = simulated.comparisons["distance"] == "near"
    one = Tables(simulated.ratings[near], simulated.comparisons[compared], simulated.participants)
    found = curves_of(one, rng, margins=DEFAULT, ranks=RANKS, experts={})
    assert found.of(RATED) == {}
    assert found.notes[0] == (
        "No curve over pixels for low: it takes answers at two sizes, and to ultra too."
    )
