"""Every error of the API as problem+json: what is wrong and how to mend it, never a traceback."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping, Sequence
from typing import Any, cast
from uuid import uuid4

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from backend.auth.keeping import Denied
from backend.ports import FactRefused, JournalDamaged
from backend.reasons import Reason
from backend.reasons import request as reasons
from backend.reasons.access import TooManyTries
from backend.search.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.store.reading import JournalUnavailable
from backend.wire.problem import FieldProblem, Problem, problem
from backend.workers import WorkersBusy, WorkStopped
from planner.reason import Reason as AnyReason
from planner.reason import ReasonedError, text_of
from planner.types import PlannerError

log = logging.getLogger("crossfix.api")

MEDIA_TYPE = "application/problem+json"
MOST_NAMED = 20
"""Wrong fields of a request, one by one; the sentence counts them all."""

PROBLEM_RESPONSES: dict[int | str, dict[str, object]] = {
    "default": {
        "description": "What went wrong and how to mend it",
        "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}},
    }
}
"""For every router: all statuses but success answer a Problem."""

STATUSES: tuple[tuple[type[ReasonedError], int], ...] = (
    (MissionNotFound, 404),
    (MissionConflict, 409),
    (FactRefused, 409),
    (JournalUnavailable, 503),
    (JournalDamaged, 500),
    (PlannerError, 422),
    (WorkStopped, 422),
    (WorkersBusy, 503),
)
"""Errors of the rooms below, and the status that they are answered with."""


class ApiProblem(HTTPException):
    """Raised by an endpoint, or while its request is read; becomes the response."""

    def __init__(
        self,
        status: int,
        reason: Reason,
        errors: Sequence[FieldProblem] = (),
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(status, text_of(reason), headers)
        self.problem = problem(status, reason, list(errors))


def not_found(what: reasons.NothingKind, which: str) -> ApiProblem:
    """To be raised."""
    return ApiProblem(404, reasons.NothingThere(what, which))


def respond(found: Problem, headers: dict[str, str] | None = None) -> JSONResponse:
    """headers: besides those of the media type."""
    return JSONResponse(found.model_dump(mode="json"), status_code=found.status, media_type=MEDIA_TYPE, headers=headers)


def field_problems(error: RequestValidationError) -> list[FieldProblem]:
    """The first MOST_NAMED of pydantic's findings with the place they are about; "body" is left off, query and path
    names stay."""
    found: list[FieldProblem] = []
    for item in error.errors()[:MOST_NAMED]:
        location: list[int | str] = list(item["loc"])
        if location and location[0] == "body":
            location = without_tags(location[1:], error.body)
        elif location and location[0] in {"query", "path"}:
            location = location[1:]
        found.append(FieldProblem(field=".".join(map(str, location)), reason=_field_reason(item)))
    return found


def without_tags(location: list[int | str], sent: object) -> list[int | str]:
    """The place in what was sent: pydantic names the member of a union (its `kind` or `type`) as if it were a field."""
    path: list[int | str] = []
    for part in location:
        if isinstance(sent, dict):
            fields = cast("dict[int | str, object]", sent)
            if part not in fields and part in (fields.get("kind"), fields.get("type")):
                continue
            sent = fields.get(part)
        elif isinstance(sent, list):
            members = cast("list[object]", sent)
            sent = members[part] if isinstance(part, int) and part < len(members) else None
        else:
            sent = None
        path.append(part)
    return path


def _field_reason(item: dict[str, Any]) -> Reason:
    context = item.get("ctx", {})
    match item["type"]:
        case "missing":
            return reasons.FieldMissing()
        case "extra_forbidden" | "unexpected_keyword_argument":
            return reasons.FieldUnknown()
        case "greater_than":
            return reasons.FieldOutOfRange("greater_than", float(context["gt"]))
        case "greater_than_equal":
            return reasons.FieldOutOfRange("greater_than_equal", float(context["ge"]))
        case "less_than":
            return reasons.FieldOutOfRange("less_than", float(context["lt"]))
        case "less_than_equal":
            return reasons.FieldOutOfRange("less_than_equal", float(context["le"]))
        case "string_too_short" | "too_short":
            return reasons.FieldWrongLength("least", int(context["min_length"]))
        case "string_too_long" | "too_long":
            return reasons.FieldWrongLength("most", int(context["max_length"]))
        case "literal_error" | "enum":
            return reasons.FieldNotOneOf(str(context["expected"]))
        case _:
            return reasons.FieldInvalid(str(item["msg"]).removeprefix("Value error, ").rstrip("."))


async def on_problem(_: Request, error: Exception) -> JSONResponse:
    """What an endpoint raised on purpose."""
    assert isinstance(error, ApiProblem)
    return respond(error.problem, dict(error.headers) if error.headers else None)


async def on_invalid(_: Request, error: Exception) -> JSONResponse:
    """422, with a line for each field."""
    assert isinstance(error, RequestValidationError)
    errors, faults = field_problems(error), len(error.errors())
    first = errors[0].field if errors else ""
    return respond(problem(422, reasons.RequestInvalid(first, max(faults, 1)), errors))


async def on_mission_input(_: Request, error: Exception) -> JSONResponse:
    """422, at the field of the specification that makes no sense."""
    assert isinstance(error, MissionInputError)
    return respond(problem(422, error.reason, [FieldProblem(field=error.field, reason=error.reason)]))


async def on_reasoned(_: Request, error: Exception) -> JSONResponse:
    """The status by the error's class (STATUSES), the words by its reason."""
    assert isinstance(error, ReasonedError)
    status = next(status for kind, status in STATUSES if isinstance(error, kind))
    return respond(problem(status, error.reason))


async def on_denied(_: Request, error: Exception) -> JSONResponse:
    """With the seconds to wait, where there are any."""
    assert isinstance(error, Denied)
    return respond(problem(error.status, error.reason), retry_after(error.reason))


def retry_after(reason: AnyReason) -> dict[str, str] | None:
    """The header that tells a program when to come back."""
    return {"retry-after": str(math.ceil(reason.wait_s))} if isinstance(reason, TooManyTries) else None


async def on_http(_: Request, error: Exception) -> JSONResponse:
    """What the framework itself refuses, such as a method that is not allowed."""
    assert isinstance(error, HTTPException)
    found = problem(error.status_code, reasons.HttpRefused(error.status_code, str(error.detail)))
    return respond(found, dict(error.headers) if error.headers else None)


async def on_fault(request: Request, error: Exception) -> JSONResponse:
    """A fault of our own: the operator gets an id to quote, the log gets the traceback."""
    incident = uuid4().hex[:12]
    log.error("incident %s: %s %s", incident, request.method, request.url.path, exc_info=error)
    return respond(
        problem(500, reasons.ServerBroke(incident)), {"connection": "close"}
    )  # after it the server closes it


def install(app: FastAPI) -> None:
    """For every error, the unexpected ones too."""
    app.add_exception_handler(ApiProblem, on_problem)
    app.add_exception_handler(RequestValidationError, on_invalid)
    app.add_exception_handler(HTTPException, on_http)
    app.add_exception_handler(MissionInputError, on_mission_input)
    app.add_exception_handler(Denied, on_denied)
    for kind, _ in STATUSES:
        app.add_exception_handler(kind, on_reasoned)
    app.add_exception_handler(Exception, on_fault)
