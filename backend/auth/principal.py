"""Who asks. Until users can sign in, everybody who reaches the loopback address is the operator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Role = Literal["viewer", "operator", "pilot", "admin"]


@dataclass(frozen=True, slots=True)
class Principal:
    """name: written into the facts as `by`."""

    name: str
    role: Role


LOCAL_OPERATOR = Principal(name="operator", role="operator")


def current_principal() -> Principal:
    """FastAPI dependency: the caller of this request."""
    return LOCAL_OPERATOR
