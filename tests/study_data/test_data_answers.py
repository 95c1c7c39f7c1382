"""Answers and events: stored once, kept for ever, fixed when the trial is complete."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from study.data import answers, events, progress, trials, views
from study.data.answers import Stored
from study.data.database import Database
from study.data.refusals import NotReachedError, NotWatchedError, UnusablePayloadError
from study.data.schema import EventRow
from study.design.questions import AnswerError

MISSING = {
    "comparison": None,
    "rating_left": None,
    "rating_right": None,
    "comments": None,
    "uncanny": None,
}


def trial(walk: Any, position: int) -> trials.Trial:
    found = trials.at(walk.db, walk.participant, position)
    assert found is not None
    return found


def store(walk: Any, position: int, key: str, **rest: Any) -> Stored:
    final = rest.pop("is_final", False)
    return answers.store(walk.db, walk.participant, position, rest, key=key, is_final=final)


@pytest.fixture
def begun(walk: Any) -> Any:
    walk.begin()
    return walk


def test_every_answer_is_stored_when_given(begun: Any) -> None:
    store(begun, 1, "k1", rating_left="4")
    store(begun, 1, "k2", comments="Ünicode 🎈 שלום")
    assert trial(begun, 1).answers == {"rating_left": 4, "comments": "Ünicode 🎈 שלום"}
    assert not trial(begun, 1).is_complete


def test_the_same_key_is_the_same_answer(begun: Any) -> None:
    assert store(begun, 1, "k", rating_left="4").new
    assert store(begun, 1, "k", rating_left="1") == Stored(False, False, False)
    assert trial(begun, 1).answers == {"rating_left": 4}
    assert sum(e.kind == "answered" for e in events.history(begun.db, begun.participant)) == 1


def test_the_last_answer_counts_while_the_trial_is_open(begun: Any) -> None:
    for number, value in enumerate(("4", "1", "")):
        store(begun, 1, f"k{number}", rating_left=value)
    assert trial(begun, 1).answers == {"rating_left": None}


def test_finishing_stores_skipped_questions_as_missing(begun: Any) -> None:
    begun.watch(1)
    store(begun, 1, "draft", comments="before")
    stored = store(begun, 1, "final", rating_left="2", is_final=True)
    assert stored == Stored(new=True, is_amendment=False, trial_complete=True)
    assert trial(begun, 1).answers == {**MISSING, "rating_left": 2, "comments": "before"}
    assert trial(begun, 1).is_complete


def test_a_double_submit_is_one_submit(begun: Any) -> None:
    begun.watch(1)
    store(begun, 1, "final", rating_left="2", is_final=True)
    before = events.history(begun.db, begun.participant)
    again = store(begun, 1, "final", rating_left="2", is_final=True)
    assert again == Stored(new=False, is_amendment=False, trial_complete=True)
    assert events.history(begun.db, begun.participant) == before
    assert progress.current_step(begun.db, begun.participant).name == "trial"


def test_an_answer_to_a_complete_trial_is_kept_as_amendment_and_does_not_count(
    begun: Any,
) -> None:
    begun.answer(1, rating_left="2")
    done_at = trial(begun, 1).completed_at
    late = store(begun, 1, "late", rating_left="5", is_final=True)
    assert late == Stored(new=True, is_amendment=True, trial_complete=True)
    assert trial(begun, 1).answers["rating_left"] == 2
    assert trial(begun, 1).completed_at == done_at
    amended = [e for e in events.history(begun.db, begun.participant) if e.kind == "amended"]
    assert [e.payload["answers"]["rating_left"] for e in amended] == [5]


def test_a_trial_ahead_cannot_be_answered_or_played(begun: Any) -> None:
    with pytest.raises(NotReachedError, match="trial 2 comes after the ones before it"):
        store(begun, 2, "k", rating_left="1")
    with pytest.raises(NotReachedError, match="trial 3 comes after"):
        begun.watch(3)
    with pytest.raises(NotReachedError, match="there is no trial 99 yet"):
        store(begun, 99, "k", rating_left="1")
    assert trial(begun, 2).answers == {}


def test_a_clip_has_to_be_watched_to_the_end_first(begun: Any) -> None:
    begun.play["is_complete"] = False
    begun.watch(1)
    with pytest.raises(NotWatchedError, match="watched to the end 1 x first; so far 0 x"):
        store(begun, 1, "final", is_final=True)
    begun.play["is_complete"] = True
    begun.watch(1, number=2)
    assert store(begun, 1, "final", is_final=True).trial_complete
    assert trial(begun, 1).views == 1


def test_faulty_answers_leave_nothing_behind(begun: Any) -> None:
    begun.watch(1)
    with pytest.raises(AnswerError) as caught:
        store(begun, 1, "final", rating_left="9", comments="x" * 51, is_final=True)
    assert set(caught.value.faults) == {"rating_left", "comments"}
    assert trial(begun, 1).answers == {}
    assert store(begun, 1, "final", rating_left="5", is_final=True).new


def test_plays_are_counted_once_each(begun: Any) -> None:
    begun.watch(1)
    begun.watch(1)
    begun.watch(1, number=2)
    assert trial(begun, 1).views == 2


def test_a_play_after_the_trial_is_complete_is_no_view(begun: Any, clock: Any) -> None:
    begun.answer(1)
    clock.move(seconds=1)
    begun.watch(1, number=2)
    assert trial(begun, 1).views == 1
    assert [e.kind for e in events.history(begun.db, begun.participant)].count("played") == 2


def test_a_trial_starts_with_its_first_sign(begun: Any, clock: Any) -> None:
    first = clock.now
    begun.watch(1)
    clock.move(seconds=30)
    store(begun, 1, "k", rating_left="1")
    assert trial(begun, 1).started_at == first
    assert trial(begun, 2).started_at is None


@pytest.mark.parametrize("key", ["", "x" * 101, "a\x00b"])
def test_a_key_that_cannot_be_stored_is_refused(begun: Any, key: str) -> None:
    with pytest.raises(UnusablePayloadError, match="1 to 100 characters"):
        events.record(begun.db, begun.participant, key=key, kind="problem")


@pytest.mark.parametrize(
    ("payload", "message"),
    [
        ({"a": object()}, "has to be plain JSON"),
        ({"a": float("inf")}, "has to be plain JSON"),
        ({"a": "x" * 200_001}, "at most 200000 bytes; found 200010"),
    ],
)
def test_a_payload_that_cannot_be_stored_is_refused(
    begun: Any, payload: dict[str, Any], message: str
) -> None:
    with pytest.raises(UnusablePayloadError, match=message):
        events.record(begun.db, begun.participant, key="k", kind="problem", payload=payload)


def test_events_of_any_kind_belong_to_their_trial(begun: Any) -> None:
    for _ in range(2):
        events.record(
            *(begun.db, begun.participant),
            key="p",
            kind="problem",
            payload={"code": "CLIP\x00-\ud800", "list": [1, {"a": None}]},
            position=1,
        )
    last = events.history(begun.db, begun.participant)[-1]
    assert (last.kind, last.position) == ("problem", 1)
    assert last.payload == {"code": "CLIP-?", "list": [1, {"a": None}]}
    assert sum(e.kind == "problem" for e in events.history(begun.db, begun.participant)) == 1


def test_an_event_cannot_be_changed(db: Database, begun: Any) -> None:
    def change() -> None:
        with db.writing() as session:
            session.get_one(EventRow, 1).kind = "other"

    before = events.history(db, begun.participant)
    with pytest.raises(RuntimeError, match="events are added, never changed"):
        change()
    assert events.history(db, begun.participant) == before


def test_a_double_click_from_two_connections_is_stored_once(begun: Any) -> None:
    begun.watch(1)
    stored: list[Stored] = []
    gate = threading.Barrier(4)

    def click() -> None:
        gate.wait()
        stored.append(store(begun, 1, "final", rating_left="3", is_final=True))

    threads = [threading.Thread(target=click) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(each.new for each in stored) == [False, False, False, True]
    assert [each.trial_complete for each in stored] == [True] * 4


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["k1", "k2", "k3", "k4"]),
            st.sampled_from(["rating_left", "comments", "uncanny"]),
            st.sampled_from(["", "1", "2", "5"]),
        ),
        max_size=12,
    )
)
def test_any_order_of_repeated_answers_keeps_the_first_of_each_key_and_the_last_of_each_question(
    enrol_walk: Any, sent: list[tuple[str, str, str]]
) -> None:
    walk = enrol_walk(1)
    walk.begin()
    expected: dict[str, Any] = {}
    known: set[str] = set()
    for key, question, value in sent:
        stored = store(walk, 1, key, **{question: value})
        assert stored.new == (key not in known)
        if key not in known:
            read = value if question == "comments" else value and int(value)
            expected[question] = read or None
        known.add(key)
    assert trial(walk, 1).answers == expected


def test_a_play_that_was_cut_is_recorded_but_no_view(begun: Any) -> None:
    recorded = views.record(
        begun.db, begun.participant, 1, key="cut", play={"is_complete": False, "duration_ms": 3}
    )
    assert recorded.new
    assert trial(begun, 1).views == 0
    assert events.history(begun.db, begun.participant)[-1].payload["duration_ms"] == 3
