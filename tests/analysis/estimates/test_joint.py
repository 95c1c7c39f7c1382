"""The joint scale: gradients, closed forms, recovery, narrower intervals, and what links it."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.special import ndtri

from analysis.estimates.joint import Joint, joint_of
from analysis.estimates.linkage import linkage_of
from analysis.estimates.preference import JOD
from analysis.estimates.realism import realism_of

LODS = ("low", "medium", "ultra")
RANKS = {"low": 0, "medium": 1, "ultra": 3}
PLACES = {
    ("near", "low"): 0.0,
    ("near", "medium"): 0.9,
    ("near", "ultra"): 1.6,
    ("far", "low"): 0.6,
    ("far", "medium"): 1.0,
    ("far", "ultra"): 1.2,
}
SCALE = 0.8  # comparisons' units in one of the ratings'


def rated(
    rng: np.random.Generator, people: int, times: int, *, tau: tuple[float, ...]
) -> pd.DataFrame:
    """Return ratings of every cell by people who differ in leniency."""
    leniency = rng.normal(0, 0.4, people)
    rows = [
        (f"p{i}", distance, lod, 1 + int(np.searchsorted(tau, place + leniency[i] + e)))
        for i in range(people)
        for (distance, lod), place in PLACES.items()
        for e in rng.standard_normal(times)
    ]
    table = pd.DataFrame(rows, columns=["participant", "distance", "lod", "rating"])
    table = table.assign(other_lod=table["lod"], eye="left", is_practice=False, iris_px=50.0)
    return table.assign(lod_rank=table["lod"].map(RANKS))


def compared(rng: np.random.Generator, people: int, times: int) -> pd.DataFrame:
    """Return comparisons with ultra, drawn apart from the ratings."""
    rows = []
    for i in range(people):
        for distance in ("near", "far"):
            for lod in LODS[:2]:
                d = SCALE * (PLACES[distance, "ultra"] - PLACES[distance, lod])
                for e in rng.standard_normal(times):
                    side = rng.random() < 0.5
                    answer = int(d + e > 0.5) - int(d + e < -0.5)
                    pair = (lod, "ultra", answer) if side else ("ultra", lod, -answer)
                    rows.append((f"p{i}", distance, *pair))
    names = ["participant", "distance", "left_lod", "right_lod", "comparison"]
    return pd.DataFrame(rows, columns=names).assign(is_practice=False, iris_px=50.0)


def fitted(ratings: pd.DataFrame, comparisons: pd.DataFrame, top: int = 5) -> Joint:
    realism = realism_of(ratings, np.random.default_rng(1), scale=(1, top))
    found = joint_of(realism, comparisons, np.random.default_rng(2))
    assert found is not None
    return found


@pytest.fixture(scope="module")
def joint() -> Joint:
    rng = np.random.default_rng(7)
    ratings = rated(rng, 40, 3, tau=(-0.5, 0.5, 1.2, 2.0))
    return fitted(ratings, compared(rng, 40, 8))


def test_known_places_and_the_scale_are_recovered(joint: Joint) -> None:
    place, draws = joint.latent()
    low, high = np.quantile(draws, (0.005, 0.995), axis=0)
    own = np.array([PLACES[cell] for cell in joint.cells]) - PLACES[joint.cells[0]]
    assert ((low <= own) & (own <= high)).all()
    assert place == pytest.approx(own, abs=0.3)
    per_unit, drawn = joint.jod_per_unit()
    assert np.quantile(drawn, 0.005) < JOD * SCALE < np.quantile(drawn, 0.995)
    assert per_unit == pytest.approx(JOD * SCALE, rel=0.2)


def test_comparisons_of_their_own_make_intervals_narrower(joint: Joint) -> None:
    table = joint.table(dict.fromkeys(("near", "far"), "ultra")).set_index(["distance", "lod"])
    assert list(table) == [
        *("latent", "latent_low", "latent_high", "rating", "rating_low", "rating_high"),
        *("loss", "loss_low", "loss_high", "loss_alone_low", "loss_alone_high", "width_ratio"),
    ]
    ratios = table["width_ratio"].dropna()
    assert len(ratios) == 4
    assert ratios.mean() < 0.9
    assert table.loc[("near", "ultra"), ["loss", "width_ratio"]].isna().all()


def test_the_gradient_is_that_of_differences(joint: Joint) -> None:
    model = joint.fit.model
    at = joint.fit.parameters + np.random.default_rng(3).normal(0, 0.1, len(model.names))
    steps = np.eye(len(at)) * 1e-5
    by_difference = [(model.value(at + s)[0] - model.value(at - s)[0]) / 2e-5 for s in steps]
    assert model.value(at)[1] == pytest.approx(by_difference, rel=1e-5, abs=1e-4)
    assert model.by_person(at).sum() == pytest.approx(model.value(at)[0])
    first, second = model.split(at)
    again = model.join(first, second, log_scale=at[len(first)])
    assert again == pytest.approx(at)


def test_two_categories_and_one_pair_are_their_closed_forms() -> None:
    def answers(lod: str, high: int) -> pd.DataFrame:
        people = [f"p{i % 50}" for i in range(500)]
        table = pd.DataFrame({"participant": people, "distance": "near", "lod": lod})
        table = table.assign(rating=[2] * high + [1] * (500 - high), other_lod=lod, eye="left")
        return table.assign(is_practice=False, iris_px=50.0, lod_rank=RANKS[lod])

    ratings = pd.concat([answers("low", 150), answers("ultra", 350)], ignore_index=True)
    pairs = [("low", "ultra", 1)] * 600 + [("low", "ultra", 0)] * 250 + [("low", "ultra", -1)] * 150
    mirrored = [(right, left, -answer) for left, right, answer in pairs]
    comparisons = pd.DataFrame(
        pairs + mirrored, columns=["left_lod", "right_lod", "comparison"]
    ).sample(frac=1.0, random_state=1)
    comparisons = comparisons.assign(
        participant=[f"p{i % 50}" for i in range(2000)], distance="near", is_practice=False
    ).assign(iris_px=50.0)
    found = fitted(ratings, comparisons, top=2)
    # One gap: the scale takes what the comparisons say, the place what the ratings say.
    assert found.latent()[0][1] == pytest.approx(2 * ndtri(0.7), abs=0.05)
    d = -(ndtri(0.15) + ndtri(0.40)) / 2
    assert found.jod_per_unit()[0] == pytest.approx(JOD * d / (2 * ndtri(0.7)), rel=0.06)
    assert found.expected()[0] == pytest.approx([1.3, 1.7], abs=0.01)


def test_comparisons_of_what_was_not_rated_take_no_part() -> None:
    rng = np.random.default_rng(7)
    ratings = rated(rng, 5, 2, tau=(-0.5, 0.5, 1.2, 2.0))
    comparisons = compared(rng, 5, 2)
    realism = realism_of(ratings, rng, scale=(1, 5))
    assert joint_of(realism, comparisons.assign(distance="moon"), rng) is None
    assert joint_of(realism, comparisons.iloc[:0], rng) is None
    equal = comparisons.assign(left_lod="ultra", right_lod="ultra")
    assert joint_of(realism, equal, rng) is None
    weighed = joint_of(realism, comparisons, rng, weights={"p0": 0.2})
    assert weighed is not None
    assert weighed.compared == len(comparisons)


def test_linkage_tells_what_hangs_together() -> None:
    rng = np.random.default_rng(7)
    ratings = rated(rng, 6, 1, tau=(-0.5, 0.5, 1.2, 2.0))
    comparisons = compared(rng, 6, 1)
    whole = linkage_of(ratings, comparisons)
    assert whole.is_one
    assert whole.compared == (
        (("near", "low"), ("near", "medium"), ("near", "ultra")),
        (("far", "low"), ("far", "medium"), ("far", "ultra")),
    )
    assert whole.sentences() == (
        "Comparisons link LoDs within a distance; distances are linked by the people who rated "
        "eyes at several of them.",
    )
    few = ratings["participant"].isin(["p0", "p1", "p2"])
    apart = ratings[few == (ratings["distance"] == "near")]
    split = linkage_of(apart, comparisons)
    assert [group[0][0] for group in split.linked] == ["near", "far"]
    assert split.sentences()[0] == "Comparisons link LoDs within a distance alone."
    assert (
        "nobody rated eyes of two of these groups (near: low, medium and ultra; far: "
        in (split.sentences()[1])
    )
    unrated = linkage_of(ratings[ratings["distance"] == "near"], comparisons)
    assert unrated.is_one
    assert unrated.sentences()[-1] == (
        "Compared but never rated, so without a place on the joint scale: far: low, medium and "
        "ultra."
    )
