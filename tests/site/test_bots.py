"""Simulated participants on the real pages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from study import bots
from study.browser import BotError
from study.data import events, export
from study.site.signatures import simulation_token


def walk(site: Any, count: int = 1, token: str | None = None) -> list[str]:
    return bots.walk(
        site.url,
        site.study.definition,
        media_folder=site.settings.media_folder,
        simulation_token=token or simulation_token(site.settings.secret_key()),
        participants=count,
        seed=7,
    )


def test_a_bot_completes_a_session_and_the_export_holds_exactly_its_answers(site: Any) -> None:
    codes = walk(site, 2)
    assert len(set(codes)) == 2
    tables = export.tables(site.db, site.study)
    assert list(tables.participants["simulated"]) == [True, True]
    assert list(tables.participants["status"]) == ["completed", "completed"]
    given: dict[tuple[str, int, str], Any] = {}
    for person in site.people():
        for event in events.history(site.db, person):
            if event.kind == "answered":
                for question, value in event.payload["answers"].items():
                    given[person.public_id, event.position or 0, question] = value
    exported = {
        (row["participant"], int(row["trial"].rpartition("-")[2]), f"rating_{row['eye']}"): (
            None if row.isna()["rating"] else int(row["rating"])
        )
        for _, row in tables.ratings.iterrows()
    }
    assert len(exported) == 2 * 3 * 2
    assert exported == {key: value for key, value in given.items() if "rating" in key[2]}


def test_the_same_seed_gives_the_same_answers(site: Any) -> None:
    walk(site)
    walk(site)
    ratings = export.tables(site.db, site.study).ratings
    ratings["trial"] = ratings["clip"] + ratings["eye"]
    people = [
        group.drop_duplicates("trial").set_index("trial")["views"].sort_index().tolist()
        for _, group in ratings[ratings["is_practice"]].groupby("participant")
    ]
    assert people[0] == people[1]


def test_the_public_cannot_pass_for_simulated(site: Any) -> None:
    with pytest.raises(BotError, match="/consent: the site answered 403"):
        walk(site, token="made up")
    assert len(export.tables(site.db, site.study).participants) == 0


def test_a_simulated_participant_is_labelled_on_every_page(site: Any) -> None:
    person = site.guest(**site.simulation)
    assert ">SIMULATED<" in person.walk_to_trial().text
    person.client.close()
    real = site.guest()
    assert ">SIMULATED<" not in real.walk_to_trial().text
    real.client.close()


def test_a_bot_says_when_nobody_answers(site: Any) -> None:
    with pytest.raises(BotError, match=r"http://127\.0\.0\.1:9/consent: no answer .*is the site"):
        bots.walk(
            "http://127.0.0.1:9",
            site.study.definition,
            media_folder=Path("nowhere"),
            simulation_token="x",
            participants=1,
            seed=1,
        )


@pytest.mark.parametrize("are_clips_ready", [False])
def test_a_bot_says_when_clips_are_missing(site: Any) -> None:
    with pytest.raises(BotError, match=r"the clips are not rendered yet \(0%\); wait"):
        walk(site)
