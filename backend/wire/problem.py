"""How the API says no: RFC 9457 problem details around a reason. Media type application/problem+json."""

from __future__ import annotations

from pydantic import Field

from backend.reasons import Reason
from backend.spec import Model
from planner.reason import remedy_of, text_of


class FieldProblem(Model):
    """`field`: path into the request, dots between names and indices ("spec.sensor.sigma_deg", "after")."""

    field: str
    reason: Reason


class Problem(Model):
    """reason: what went wrong and how to mend it, for a program. title, detail, remedy: the same in English, for people
    without our page."""

    type: str = "about:blank"
    title: str
    status: int
    detail: str
    remedy: str
    reason: Reason
    errors: list[FieldProblem] = Field(default_factory=list[FieldProblem])


TITLES = {
    401: "Not signed in",
    403: "Not allowed",
    404: "Not found",
    405: "Method not allowed",
    409: "Not possible now",
    413: "Too large",
    421: "Unknown host",
    422: "The request is not valid",
    429: "Too often",
    500: "The server made a mistake",
    503: "Not available at the moment",
    507: "The disk is full",
}


def problem(status: int, reason: Reason, errors: list[FieldProblem] | None = None) -> Problem:
    """Title and detail are the English of status and reason."""
    return Problem(
        title=TITLES.get(status, "The request was refused"),
        status=status,
        detail=text_of(reason),
        remedy=remedy_of(reason),
        reason=reason,
        errors=errors or [],
    )
