"""What this installation signs with its secret key: who says so must have read the data folder.

No web framework here: the command line signs for its simulated participants too.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import time
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final

from itsdangerous import BadSignature, URLSafeTimedSerializer

SIMULATION_HEADER: Final = "X-Ocularist-Simulation"
SIGN_IN_S: Final = 12 * 3600  # a researcher's working day
SIMULATION_S: Final = 24 * 3600
PARTICIPANT_S: Final = 60 * 24 * 3600
ARRIVAL_S: Final = 24 * 3600
DAY_S: Final = 24 * 3600


def csrf_token(secret: str, credential: str) -> str:
    """Return what a form must carry so that it counts for the holder of a cookie."""
    return hmac.digest(secret.encode(), f"csrf:{credential}".encode(), "sha256").hex()


def is_csrf_token(secret: str, credential: str, given: str) -> bool:
    """Say whether a form carries the token of this cookie."""
    return hmac.compare_digest(csrf_token(secret, credential).encode(), given.encode())


def who_hash(secret: str, who: str) -> str:
    """Return a name for an address or a person that nobody without the secret can turn back."""
    return hmac.new(secret.encode(), f"address:{who}".encode(), hashlib.sha256).hexdigest()


def simulation_token(secret: str) -> str:
    """Return what proves that a participant is simulated by someone with this data folder."""
    return _serializer(secret, "simulation").dumps("simulated")


def is_simulation_token(secret: str, token: str) -> bool:
    """Say whether a token proves a simulation; the public cannot make one."""
    return _load(_serializer(secret, "simulation"), token, SIMULATION_S) == "simulated"


def sign_researcher(secret: str, researcher_id: int) -> str:
    """Return the cookie of a researcher who has signed in."""
    return _serializer(secret, "researcher").dumps(researcher_id)


def read_researcher(secret: str, cookie: str) -> int | None:
    """Return whose cookie this is, or None when it is not ours or too old."""
    found = _load(_serializer(secret, "researcher"), cookie, SIGN_IN_S)
    return found if isinstance(found, int) else None


def sign_participant(secret: str, public_id: str) -> str:
    """Return a cookie for somebody who is known by what brought them, not by their token."""
    return _serializer(secret, "participant").dumps(public_id)


def read_participant(secret: str, cookie: str) -> str | None:
    """Return whose cookie this is, or None when it is not ours or too old."""
    found = _load(_serializer(secret, "participant"), cookie, PARTICIPANT_S)
    return found if isinstance(found, str) else None


def sign_outbox(secret: str, public_id: str) -> str:
    """Return what lets a browser deliver a participant's answers, and nothing else.

    It stays with the answers while they wait there, so that they arrive under their own name even
    when somebody else has begun in that browser since.
    """
    return _outbox_of_the_day(secret, public_id, int(time.time()) // DAY_S)


@lru_cache(maxsize=20_000)
def _outbox_of_the_day(secret: str, public_id: str, _day: int) -> str:
    """Sign once a day: every page of a participant carries it, and signing takes longer."""
    return _serializer(secret, "outbox").dumps(public_id)


def read_outbox(secret: str, text: str) -> str | None:
    """Return whose answers may be delivered with this, or None."""
    found = _load(_serializer(secret, "outbox"), text, PARTICIPANT_S)
    return found if isinstance(found, str) else None


def sign_arrival(secret: str, arrival: Mapping[str, Any]) -> str:
    """Return a cookie with what brought somebody here."""
    return str(_serializer(secret, "arrival").dumps(arrival))


def read_arrival(secret: str, cookie: str) -> dict[str, Any] | None:
    """Return what brought somebody here, or None."""
    found = _load(_serializer(secret, "arrival"), cookie, ARRIVAL_S)
    return found if isinstance(found, dict) else None


def sign_ticket(secret: str, ticket: str) -> str:
    """Return what a consent form carries: the name of the participant whom it is to enrol."""
    return _serializer(secret, "ticket").dumps(ticket)


def read_ticket(secret: str, text: str) -> str | None:
    """Return the ticket of a consent form, or None when it is not ours or too old."""
    found = _load(_serializer(secret, "ticket"), text, ARRIVAL_S)
    return found if isinstance(found, str) else None


def keyed_hash(secret: str, *parts: str) -> str:
    """Return 64 hexadecimal digits that only this installation can compute."""
    message = "\x1f".join(parts).encode("utf-8", "replace")
    return hmac.new(secret.encode(), message, hashlib.sha256).hexdigest()


def keyed_token(secret: str, *parts: str) -> str:
    """Return the same in 43 characters: people write their personal link down."""
    digest = bytes.fromhex(keyed_hash(secret, *parts))
    return base64.urlsafe_b64encode(digest).decode().rstrip("=")


def _serializer(secret: str, purpose: str) -> URLSafeTimedSerializer:
    return URLSafeTimedSerializer(secret, salt=f"ocularist {purpose}")


def _load(serializer: URLSafeTimedSerializer, text: str, max_age_s: int) -> object:
    try:
        return serializer.loads(text, max_age=max_age_s)
    except BadSignature:
        return None
