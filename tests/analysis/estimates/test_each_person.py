"""Everyone's effects by the model: drawn towards the population, and in the right direction."""

import numpy as np
import pandas as pd
import pytest

from analysis.estimates.each_person import COLUMNS, each_person
from analysis.estimates.realism import realism_of
from analysis.tables.reading import Tables, tables_from


def test_leniency_follows_the_means_and_is_shrunken(thesis_tables: Tables) -> None:
    fitted = realism_of(thesis_tables.ratings, np.random.default_rng(1), scale=(1, 5))
    table = each_person(fitted)
    assert tuple(table.columns) == COLUMNS
    assert table["participant"].tolist() == list(fitted.stimuli.people)
    means = thesis_tables.ratings.groupby("participant")["rating"].mean().astype(float)
    own = table.set_index("participant")["leniency"]
    assert own.corr(means.reindex(own.index), method="spearman") > 0.85
    assert own.std() < fitted.fit.sd("leniency")
    assert (table["leniency_low"] < own.to_numpy()).all()
    assert (table["leniency_high"] > own.to_numpy()).all()
    assert table[["inconsistency", "style"]].isna().all().all()  # 16 ratings each tell none


def test_who_scatters_and_who_avoids_the_ends_stands_out() -> None:
    rng = np.random.default_rng(4)
    rows = []
    for person in range(8):
        for clip in range(12):
            for eye, shift in (("left", 0.0), ("right", 0.6)):
                for again in range(2):
                    noise = rng.normal(scale=1.6 if person == 0 else 0.5)
                    place = -1.4 + 0.25 * clip + shift + noise
                    rating = float(np.clip(np.round(3 + 1.5 * place), 1, 5))
                    if person == 1:
                        rating = float(np.clip(rating, 2, 4))
                    rows.append((f"P{person}", "near", f"L{clip}{eye}", f"{clip}{again}", rating))
    frame = pd.DataFrame(rows, columns=["participant", "distance", "lod", "clip", "rating"])
    frame = frame.assign(other_lod="x")
    fitted = realism_of(
        tables_from({"ratings": frame}).ratings, np.random.default_rng(1), scale=(1, 5)
    )
    table = each_person(fitted).set_index("participant")
    assert table["inconsistency"].idxmax() == "P0"
    assert table["inconsistency_low"]["P0"] > 1
    assert table["style"].idxmax() == "P1"
    assert table["leniency"].abs().max() < 1
    assert pytest.approx(0, abs=0.5) == np.log(table["style"]).mean()
