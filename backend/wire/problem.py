"""How the API says no: RFC 9457 problem details, with what to do about it. Media type application/problem+json."""

from __future__ import annotations

from pydantic import Field

from backend.spec import Model


class FieldProblem(Model):
    """`field`: path into the request, dots between names and indices ("spec.sensor.sigma_deg", "after")."""

    field: str
    message: str


class Problem(Model):
    """title: what went wrong in a few words; detail: the sentence to show; remedy: how to mend it ("" when unknown).

    incident: set for a fault of the server's own; the same id is in its log.
    """

    type: str = "about:blank"
    title: str
    status: int
    detail: str
    remedy: str = ""
    errors: list[FieldProblem] = Field(default_factory=list)
    incident: str | None = None
