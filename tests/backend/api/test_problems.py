"""Every error of the API is a problem whose reason the union of all reasons knows: asked of every operation."""

from __future__ import annotations

import json
from typing import Any

import pytest
from starlette.requests import Request

from backend.api.problems import MEDIA_TYPE, STATUSES, on_fault
from backend.settings import REPOSITORY
from backend.wire.problem import TITLES, Problem

SCHEMA = json.loads((REPOSITORY / "frontend/src/wire/openapi.json").read_text())
"""As test_schema.py holds it to the application: to make it takes two seconds, of each worker that only looks for its
tests, too."""
OPERATIONS = [(method, path, operation) for path, item in SCHEMA["paths"].items() for method, operation in item.items()]
NAMES = [operation["operationId"] for _, _, operation in OPERATIONS]
OTHER_METHOD = {"get": "PATCH", "post": "PATCH", "put": "PATCH", "delete": "PATCH", "patch": "TRACE"}


def filled(path: str, value: str) -> str:
    """The path with `value` for each of its parameters."""
    return "/".join(value if part.startswith("{") else part for part in path.split("/"))


def refusals(method: str, path: str, operation: dict[str, Any]) -> list[tuple[str, str, dict[str, Any]]]:
    """Requests that none can answer well: (method, path, more for the client)."""
    verb, asked = method.upper(), [(OTHER_METHOD[method], filled(path, "nobody"), {})]
    asked.append((verb, filled(path, "nobody"), {"headers": {"host": "evil.example"}}))
    if verb != "GET":
        asked.append((verb, filled(path, "nobody"), {"headers": {"origin": "http://evil.example"}}))
    if "{" in path:
        asked += [(verb, filled(path, "nobody"), {}), (verb, filled(path, "no%20such%20id!"), {})]
    if "requestBody" in operation:
        for body in (b"", b"{", b'{"unexpected": 1}', b"[" * 50_000):
            asked.append(
                (verb, filled(path, "nobody"), {"content": body, "headers": {"content-type": "application/json"}})
            )
    queries = [p for p in operation.get("parameters", ()) if p["in"] == "query"]
    asked += [(verb, filled(path, "nobody"), {"params": {p["name"]: "\u00e9 " * 300}}) for p in queries]
    return asked


@pytest.mark.parametrize(("method", "path", "operation"), OPERATIONS, ids=NAMES)
async def test_every_refusal_carries_a_reason(client, method, path, operation):
    for verb, url, more in refusals(method, path, operation):
        reply = await client.request(verb, url, **more)
        assert 400 <= reply.status_code < 500, (verb, url, more, reply.text[:300])
        assert reply.headers["content-type"] == MEDIA_TYPE, (verb, url, more)
        problem = Problem.model_validate_json(reply.content)
        assert problem.status == reply.status_code
        assert problem.detail
        assert Problem.model_validate(problem.model_dump(mode="json")) == problem


async def test_a_fault_of_the_server_says_that_it_closes_the_connection(caplog):
    request = Request({"type": "http", "method": "GET", "path": "/api/calibration", "headers": []})
    answer = await on_fault(request, ValueError("broken"))
    assert (answer.status_code, answer.headers["connection"]) == (500, "close")


def test_every_status_that_is_answered_has_a_title():
    assert {status for _, status in STATUSES} <= set(TITLES)
