"""Researchers: passwords kept as argon2id, guessers slowed down, switches on record."""

from __future__ import annotations

from typing import Any

import pytest
from argon2 import PasswordHasher
from sqlalchemy import text

from study.data import logbook, researchers
from study.data.database import Database
from study.data.refusals import RefusedError
from study.data.researchers import MustWaitError, Researcher
from study.data.studies import Study

PASSWORD = "correct horse battery"


@pytest.fixture(autouse=True)
def quick_hasher(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hash as argon2id with the least of work: what is tested here is not how slow it is."""
    quick = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    monkeypatch.setattr(researchers, "_hasher", quick)
    monkeypatch.setattr(researchers, "_NOBODY", quick.hash("nobody has this password"))


@pytest.fixture
def ada(db: Database) -> Researcher:
    return researchers.add(db, " ada ", PASSWORD)


def sign_in(db: Database, name: str, password: str, address: str = "1.2.3.4") -> Any:
    return researchers.sign_in(db, name, password, address=address)


def test_only_the_right_password_signs_in(db: Database, ada: Researcher) -> None:
    assert ada.name == "ada"
    assert sign_in(db, "ada", PASSWORD) == ada
    assert sign_in(db, "ada", PASSWORD + " ") is None
    assert sign_in(db, "ADA", PASSWORD) is None
    assert sign_in(db, "nobody", "nobody has this password") is None
    assert researchers.by_id(db, ada.id) == ada
    assert researchers.by_id(db, 99) is None


def test_passwords_are_kept_as_argon2id(db: Database, ada: Researcher) -> None:
    assert ada
    with db.reading() as session:
        stored = session.execute(text("SELECT password_hash FROM researchers")).scalar_one()
    assert stored.startswith("$argon2id$")
    assert PASSWORD not in stored


def test_adding_again_changes_the_password(db: Database, ada: Researcher) -> None:
    assert researchers.has_any(db)
    assert researchers.add(db, "ada", "another long password") == ada
    assert sign_in(db, "ada", PASSWORD) is None
    assert sign_in(db, "ada", "another long password") == ada


@pytest.mark.parametrize(
    ("name", "password", "message"),
    [
        ("ada", "short", "a password has 12 to 500 characters; found 5"),
        ("ada", "x" * 501, "a password has 12 to 500 characters; found 501"),
        ("  ", PASSWORD, "a name has 1 to 100 characters; found 0"),
    ],
)
def test_what_cannot_be_an_account_is_refused(
    db: Database, name: str, password: str, message: str
) -> None:
    with pytest.raises(RefusedError, match=message):
        researchers.add(db, name, password)
    assert not researchers.has_any(db)


def test_five_failures_make_a_name_wait(db: Database, ada: Researcher, clock: Any) -> None:
    for _ in range(5):
        assert sign_in(db, "ada", "wrong") is None
        clock.move(minutes=1)
    with pytest.raises(MustWaitError, match="try again in 10 minutes") as caught:
        sign_in(db, "ada", PASSWORD, address="5.6.7.8")
    assert caught.value.wait_s == 600
    clock.move(seconds=599)
    with pytest.raises(MustWaitError, match="try again in 1 minutes"):
        sign_in(db, "ada", PASSWORD)
    clock.move(seconds=1)
    assert sign_in(db, "ada", PASSWORD) == ada


def test_an_address_that_tries_many_names_has_to_wait(db: Database, ada: Researcher) -> None:
    for number in range(20):
        assert sign_in(db, f"name-{number}", "wrong") is None
    with pytest.raises(MustWaitError):
        sign_in(db, "ada", PASSWORD)
    assert sign_in(db, "ada", PASSWORD, address="5.6.7.8") == ada


def test_signing_in_forgets_typing_errors(db: Database, ada: Researcher) -> None:
    for _ in range(4):
        for _ in range(3):
            assert sign_in(db, "ada", "wrong") is None
        assert sign_in(db, "ada", PASSWORD) == ada


def test_old_failures_are_not_kept(db: Database, clock: Any) -> None:
    for _ in range(3):
        assert sign_in(db, "nobody", "wrong") is None
        clock.move(minutes=16)
    with db.reading() as session:
        kept = session.execute(text("SELECT count(*) FROM sign_in_attempts")).scalar_one()
    assert kept == 1


def test_showing_results_is_switched_per_researcher_and_recorded(
    db: Database, ada: Researcher, study: Study, clock: Any
) -> None:
    bob = researchers.add(db, "bob", PASSWORD)
    assert not logbook.sees_results(db, ada, study)
    logbook.show_results(db, ada, study, shown=True)
    first = clock.now
    clock.move(hours=1)
    assert logbook.sees_results(db, ada, study)
    assert not logbook.sees_results(db, bob, study)
    logbook.show_results(db, ada, study, shown=False)
    assert not logbook.sees_results(db, ada, study)
    logbook.log(db, bob, "exported", study=study, payload={"format": "zip"})
    found = logbook.logged(db, study)
    assert [(entry.researcher, entry.kind) for entry in found] == [
        *(("bob", "exported"), ("ada", "results-hidden"), ("ada", "results-shown"))
    ]
    assert found[-1].created_at == first
    assert found[0].payload == {"format": "zip"}
