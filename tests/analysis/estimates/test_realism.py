"""Realism from ratings: cells, contrast, groups, and what comes back from simulated people."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.special import ndtr

from analysis.estimates.realism import Realism, realism_of
from analysis.estimates.stimuli import stimuli_of
from analysis.models.ordinal import PERSON_EFFECTS
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from

LODS = ("low", "medium", "high", "ultra")


def clips(*, with_catch: bool) -> dict[str, Stimulus]:
    shown = {}
    for distance in ("macroscopic", "far"):
        px = POPULATION.iris_px[distance]
        pairs = [(lod, "ultra") for lod in LODS[:3]] + [("ultra", lod) for lod in LODS[:3]]
        pairs += [(lod, lod) for lod in LODS] if with_catch else []
        for left, right in pairs:
            shown[f"{distance}-{left}-{right}"] = Stimulus(distance, px, left, right)
    return shown


def simulated(people: int, *, seed: int = 1, with_catch: bool = True) -> Tables:
    rng = np.random.default_rng(seed)
    return tables_from(simulate_tables(clips(with_catch=with_catch), rng, participants=people))


def fitted(tables: Tables, **options: dict[str, bool] | dict[str, float]) -> Realism:
    return realism_of(tables.ratings, np.random.default_rng(2), scale=(1, 5), **options)


@pytest.fixture(scope="module")
def crowd() -> Realism:
    return fitted(simulated(60))


def test_the_populations_means_come_back(crowd: Realism) -> None:
    rating, draws = crowd.expected()
    low, high = np.quantile(draws, (0.001, 0.999), axis=0)
    assert crowd.cells[0] == ("macroscopic", "low")
    for i, (distance, lod) in enumerate(crowd.cells):
        true = POPULATION.mean_ratings[distance][LODS.index(lod)]
        # The generator's observers differ from the model's, and 60 of them from the population.
        assert rating[i] == pytest.approx(true, abs=0.25)
        assert low[i] < rating[i] < high[i]


def test_shares_of_ratings_add_up_and_give_the_mean(crowd: Realism) -> None:
    shares, draws = crowd.categories()
    assert shares.shape == (len(crowd.cells), 5)
    assert shares.min() > 0
    assert shares.sum(axis=1) == pytest.approx(1)
    assert shares @ np.arange(1, 6) == pytest.approx(crowd.expected()[0])
    assert draws @ np.arange(1, 6) == pytest.approx(crowd.expected()[1])


def test_contrast_is_found_where_catch_pairs_show_eyes_beside_their_like(crowd: Realism) -> None:
    kappa, error = crowd.fit.value("contrast"), crowd.fit.standard_error("contrast")
    assert abs(kappa - POPULATION.contrast) < 3 * error
    assert error < 0.05


def test_gaps_are_those_of_eyes_beside_their_like_not_of_contrasted_ones() -> None:
    # Taken from pairs alone the gap is 1 + 2 kappa = 1.24 times as large.
    tables = simulated(50, seed=4)
    is_pair = tables.ratings["lod"] != tables.ratings["other_lod"]
    alone = fitted(Tables(tables.ratings[is_pair], tables.comparisons, tables.participants))

    def gap(found: Realism) -> float:
        latent = dict(zip(found.cells, found.latent()[0], strict=True))
        return float(latent["macroscopic", "ultra"] - latent["macroscopic", "low"])

    both = fitted(tables)
    contrasted = 1 + 2 * both.fit.value("contrast")
    assert gap(both) * contrasted == pytest.approx(
        gap(alone) * (1 + 2 * alone.fit.value("contrast")), rel=0.12
    )


def test_scatter_and_style_are_told_where_people_gave_enough(crowd: Realism) -> None:
    assert crowd.fit.model.effects == PERSON_EFFECTS
    few = simulated(10)
    short = Tables(few.ratings.groupby("participant").head(14), few.comparisons, few.participants)
    assert fitted(short).fit.model.effects == ("leniency",)


def test_expected_ratings_are_the_formula_without_style() -> None:
    few = simulated(10)
    short = Tables(few.ratings.groupby("participant").head(14), few.comparisons, few.participants)
    found = fitted(short)
    model, parameters = found.fit.model, found.fit.parameters
    width = np.hypot(1.0, found.fit.sd("leniency"))
    tau = model.thresholds(parameters)
    wanted = 1 + ndtr((found.latent()[0][:, None] - tau) / width).sum(axis=1)
    assert found.expected()[0] == pytest.approx(wanted, abs=1e-9)


def test_expected_ratings_are_those_of_many_drawn_people(crowd: Realism) -> None:
    model, parameters = crowd.fit.model, crowd.fit.parameters
    rng, people = np.random.default_rng(5), 200_000
    leniency, scatter, stretch = model.spreads(parameters)[:, None] * rng.standard_normal(
        (3, people)
    )
    tau = model.thresholds(parameters)
    middle = (tau[1] + tau[2]) / 2
    noise = np.exp(scatter) * rng.standard_normal(people)
    for place, wanted in zip(crowd.latent()[0], crowd.expected()[0], strict=True):
        percept = place + leniency + noise
        above = [percept > middle + np.exp(stretch) * (cut - middle) for cut in tau]
        assert wanted == pytest.approx(1 + np.sum(above, axis=0).mean(), abs=0.012)  # 4 errors


def test_experts_and_sides_are_told_apart() -> None:
    tables = simulated(24, seed=3)
    about = tables.participants.set_index("participant")["works_with_graphics"]
    experts = (about == "yes").to_dict()
    found = fitted(tables, experts=experts)
    gap, error = found.fit.value("expert"), found.fit.standard_error("expert")
    assert abs(gap + POPULATION.leniency_gap) < 3.5 * error
    assert {"right", "expert"} <= set(found.fit.model.predictor.names)


def test_a_person_without_weight_does_not_count() -> None:
    tables = simulated(10)
    name = tables.ratings["participant"].iloc[0]
    spoiled = tables.ratings.assign(
        rating=tables.ratings["rating"].where(tables.ratings["participant"] != name, 1)
    )
    without = fitted(
        Tables(
            tables.ratings[tables.ratings["participant"] != name],
            tables.comparisons,
            tables.participants,
        )
    )
    ignored = fitted(
        Tables(spoiled, tables.comparisons, tables.participants), weights={str(name): 0.0}
    )
    assert ignored.expected()[0] == pytest.approx(without.expected()[0], abs=0.02)


def test_the_table_counts_people_and_ratings() -> None:
    table = fitted(simulated(8)).table()
    assert table["people"].tolist() == [8] * 8
    assert table["ratings"].sum() > 250
    assert (table["rating_low"] < table["rating"]).all()
    assert (table["latent"].iloc[0], table["latent_low"].iloc[0]) == (0.0, 0.0)


def test_nobody_rated() -> None:
    empty = simulated(1).ratings.assign(rating=pd.NA)
    with pytest.raises(ValueError, match="ratings: no rating was given"):
        stimuli_of(empty, scale=(1, 5))
