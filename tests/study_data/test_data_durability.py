"""What was acknowledged survives a process that is killed in the middle of its work."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

from sqlalchemy import text

from study.data import events, participants, progress, trials
from study.data.database import Database, open_database
from study.data.studies import Study

ROOT = Path(__file__).parents[2]
WRITER = """
import sys
from study.data import answers, participants
from study.data.database import open_database

db = open_database(sys.argv[1])
person = participants.by_token(db, sys.argv[2])
number = 0
while True:
    number += 1
    given = {"comments": f"number {number}"}
    answers.store(db, person, 1, given, key=f"k{number}")
    print(number, flush=True)
"""


def killed_after(acknowledged: int, *arguments: str) -> int:
    """Run the writer, kill it once it has acknowledged so many answers; return the last heard."""
    with subprocess.Popen(
        [sys.executable, "-c", WRITER, *arguments], stdout=subprocess.PIPE, text=True, cwd=ROOT
    ) as writer:
        assert writer.stdout is not None
        last = [int(writer.stdout.readline()) for _ in range(acknowledged)][-1]
        writer.kill()
        heard = writer.stdout.read().split()
    return int(heard[-1]) if heard else last


def test_no_acknowledged_answer_is_lost_when_the_server_is_killed(
    db: Database, walk: Any, database_url: str
) -> None:
    walk.begin()
    last = killed_after(15, database_url, walk.token)
    stored = [
        event.payload["answers"]["comments"]
        for event in events.history(db, walk.participant)
        if event.kind == "answered"
    ]
    # The one after the last may be stored without having been acknowledged; none may be missing.
    assert stored[:last] == [f"number {number}" for number in range(1, last + 1)]
    assert len(stored) <= last + 1
    trial = trials.at(db, walk.participant, 1)
    assert trial is not None
    assert trial.answers["comments"] == stored[-1]


def test_the_database_is_whole_after_the_kill_and_people_go_on(
    db: Database, study: Study, walk: Any, database_url: str
) -> None:
    walk.begin()
    killed_after(3, database_url, walk.token)
    again = open_database(database_url)
    if database_url.startswith("sqlite"):
        with again.reading() as session:
            assert session.execute(text("PRAGMA integrity_check")).scalar_one() == "ok"
    back = participants.by_token(again, walk.token)
    assert back is not None
    now = progress.current_step(again, back)
    assert now.trial is not None
    assert (now.name, now.trial.position) == ("practice", 1)
    again.close()
    walk.finish()
    assert progress.current_step(db, walk.participant).name == "thanks"
    assert study.id == back.study_id
