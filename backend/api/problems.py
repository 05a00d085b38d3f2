"""Every error of the API as problem+json: what is wrong and how to mend it, never a traceback."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from uuid import uuid4

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from backend.mission.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.mission.ports import FactRefused
from backend.store.reading import JournalUnavailable
from backend.wire.problem import FieldProblem, Problem
from planner.types import PlannerError

log = logging.getLogger("crossfix.api")

MEDIA_TYPE = "application/problem+json"

PROBLEM_RESPONSES: dict[int | str, dict[str, object]] = {
    "default": {
        "description": "What went wrong and how to mend it",
        "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}},
    }
}
"""For every router: all statuses but success answer a Problem."""


class ApiProblem(Exception):
    """Raised by an endpoint; becomes the response."""

    def __init__(
        self, status: int, title: str, detail: str, remedy: str = "", errors: Sequence[FieldProblem] = ()
    ) -> None:
        super().__init__(detail)
        self.problem = Problem(title=title, status=status, detail=detail, remedy=remedy, errors=list(errors))


def not_found(what: str, which: str, remedy: str = "") -> ApiProblem:
    return ApiProblem(404, f"No such {what}", f"There is no {what} {which!r}.", remedy)


def conflict(detail: str, remedy: str = "") -> ApiProblem:
    return ApiProblem(409, "Not possible now", detail, remedy)


def invalid(detail: str, remedy: str = "", errors: Sequence[FieldProblem] = ()) -> ApiProblem:
    return ApiProblem(422, "The request is not valid", detail, remedy, errors)


def respond(problem: Problem, headers: dict[str, str] | None = None) -> JSONResponse:
    return JSONResponse(
        problem.model_dump(mode="json"), status_code=problem.status, media_type=MEDIA_TYPE, headers=headers
    )


def field_problems(error: RequestValidationError) -> list[FieldProblem]:
    """pydantic's findings with the place they are about; "body" is left off, query and path names stay."""
    found = []
    for item in error.errors():
        location = [str(part) for part in item["loc"]]
        if location and location[0] in {"body", "query", "path"}:
            location = location[1:]
        found.append(FieldProblem(field=".".join(location), message=item["msg"]))
    return found


async def on_problem(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, ApiProblem)
    return respond(error.problem)


async def on_invalid(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    errors = field_problems(error)
    first = errors[0] if errors else FieldProblem(field="", message="it could not be read")
    more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
    where = f"{first.field}: " if first.field else ""
    return respond(
        invalid(f"{where}{first.message}{more}", "Correct the named fields and send it again.", errors).problem
    )


async def on_mission_input(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, MissionInputError)
    errors = [FieldProblem(field=error.field, message=str(error))]
    return respond(invalid(_sentence(str(error)), _sentence(error.remedy), errors).problem)


async def on_mission_not_found(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, MissionNotFound)
    return respond(ApiProblem(404, "No such mission", _sentence(str(error)), _sentence(error.remedy)).problem)


async def on_mission_conflict(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, MissionConflict)
    return respond(conflict(_sentence(str(error)), _sentence(error.remedy)).problem)


async def on_fact_refused(_: Request, error: Exception) -> JSONResponse:
    return respond(conflict(_sentence(str(error)), "Load the mission again, then repeat it.").problem)


async def on_planner_error(_: Request, error: Exception) -> JSONResponse:
    """The specification is well-formed, but there is nothing to plan in it."""
    return respond(invalid(_sentence(str(error)), "Change the area, the fence or the planner's settings.").problem)


async def on_journal_unavailable(_: Request, error: Exception) -> JSONResponse:
    remedy = "The flight goes on and its events are kept on disk. Look at the database, then try again."
    return respond(Problem(title="The database is away", status=503, detail=str(error), remedy=remedy))


def _sentence(words: str) -> str:
    """With a capital, unless it opens with a name and a colon (a file's, a field's), and with a mark at its end."""
    if not words:
        return ""
    begun = words if words.split()[0].endswith(":") else words[0].upper() + words[1:]
    return begun if begun.endswith((".", "?", "!")) else f"{begun}."


async def on_http(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    titles = {404: "No such page", 405: "Method not allowed", 413: "Too large"}
    title = titles.get(error.status_code, "The request was refused")
    problem = Problem(title=title, status=error.status_code, detail=str(error.detail))
    return respond(problem, dict(error.headers) if error.headers else None)


async def on_fault(request: Request, error: Exception) -> JSONResponse:
    """A fault of our own: the operator gets an id to quote, the log gets the traceback."""
    incident = uuid4().hex[:12]
    log.error("incident %s: %s %s", incident, request.method, request.url.path, exc_info=error)
    return respond(
        Problem(
            title="The server made a mistake",
            status=500,
            detail=f"The request could not be done because of a fault in the server (incident {incident}).",
            remedy="The mission goes on. Try again; when it happens again, report the incident with the server's log.",
            incident=incident,
        )
    )


def install(app: FastAPI) -> None:
    app.add_exception_handler(ApiProblem, on_problem)
    app.add_exception_handler(RequestValidationError, on_invalid)
    app.add_exception_handler(HTTPException, on_http)
    app.add_exception_handler(MissionInputError, on_mission_input)
    app.add_exception_handler(MissionNotFound, on_mission_not_found)
    app.add_exception_handler(MissionConflict, on_mission_conflict)
    app.add_exception_handler(FactRefused, on_fact_refused)
    app.add_exception_handler(PlannerError, on_planner_error)
    app.add_exception_handler(JournalUnavailable, on_journal_unavailable)
    app.add_exception_handler(Exception, on_fault)
