"""What this installation signs with its secret key: who says so must have read the data folder.

No web framework here: the command line signs for its simulated participants too.
"""

from __future__ import annotations

import hashlib
import hmac
from typing import Final

from itsdangerous import BadSignature, URLSafeTimedSerializer

SIMULATION_HEADER: Final = "X-Ocularist-Simulation"
SIGN_IN_S: Final = 12 * 3600  # a researcher's working day
SIMULATION_S: Final = 24 * 3600


def csrf_token(secret: str, credential: str) -> str:
    """Return what a form must carry so that it counts for the holder of a cookie."""
    return hmac.new(secret.encode(), f"csrf:{credential}".encode(), hashlib.sha256).hexdigest()


def is_csrf_token(secret: str, credential: str, given: str) -> bool:
    """Say whether a form carries the token of this cookie."""
    return hmac.compare_digest(csrf_token(secret, credential).encode(), given.encode())


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


def _serializer(secret: str, purpose: str) -> URLSafeTimedSerializer:
    return URLSafeTimedSerializer(secret, salt=f"ocularist {purpose}")


def _load(serializer: URLSafeTimedSerializer, text: str, max_age_s: int) -> object:
    try:
        return serializer.loads(text, max_age=max_age_s)
    except BadSignature:
        return None
