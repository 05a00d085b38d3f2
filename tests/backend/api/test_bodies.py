"""What comes in the body of a request costs the event loop little, whatever it holds."""

from __future__ import annotations

import asyncio
import json

import pytest
from facts import SPEC

from backend.api import bodies
from backend.api.bodies import MOST_FIELDS, MOST_ITEMS, PIECE_BYTES, Bodies, most_bytes, too_rich


def reason(reply) -> dict:
    return reply.json()["reason"]


@pytest.mark.parametrize(
    ("text", "rich"),
    [
        (json.dumps({f"k{n}": n for n in range(MOST_FIELDS + 1)}), True),
        (json.dumps({f"k{n}": n for n in range(MOST_FIELDS)}), False),
        (json.dumps([0] * (MOST_ITEMS + 2)), True),
        (json.dumps([0] * (MOST_ITEMS + 1)), False),
        ('{"a" : ' * (MOST_FIELDS + 1), True),
        (json.dumps({"text": json.dumps({'a,:"': ",:\\" * MOST_ITEMS})}), False),
        (json.dumps({"\\": 0, "b": [0] * (MOST_ITEMS + 2)}), True),
    ],
)
def test_fields_and_items_are_counted_and_what_is_inside_a_text_is_not(text: str, rich: bool) -> None:
    assert too_rich(text.encode()) == rich


def test_more_quotes_than_any_request_has_are_too_rich() -> None:
    assert too_rich(b'"' * 8_000_000)


@pytest.mark.parametrize("shift", range(8))
@pytest.mark.parametrize("rich", [True, False])
def test_a_text_that_lies_across_pieces_stays_one(shift: int, rich: bool) -> None:
    """Escaped quotes and backslashes fall on every place of a border."""
    inside = 'a\\",:' * 3 + "\\" + ",:" * MOST_ITEMS
    text = json.dumps(["x" * (PIECE_BYTES - 16 + shift), inside, *[0] * (MOST_ITEMS - (0 if rich else 1))])
    assert too_rich(text.encode()) == rich


async def test_thousands_of_wrong_fields_are_refused_before_they_are_looked_at(client) -> None:
    many = {f"k{n}": 0 for n in range(10_000)}
    assert (await client.post("/api/missions", json=many)).status_code == 413
    reply = await client.post("/api/missions", json={f"k{n}": 0 for n in range(1000)})
    assert reply.status_code == 422
    assert reason(reply)["faults"] > 1000
    assert len(reply.json()["errors"]) == 20


async def test_of_thousands_of_wrong_positions_one_is_named(client) -> None:
    body = SPEC.model_dump(mode="json")
    body["area"]["coordinates"] = [[[None, None]] * 5000]
    reply = await client.post("/api/missions", json=body)
    assert reply.status_code == 422
    assert reason(reply)["faults"] <= 2


async def test_an_upload_of_an_area_says_what_is_wrong_with_it(client) -> None:
    for body, field in ((b"[]", ""), (b"{", ""), (b'{"text": 1}', "text"), (b'{"text": "", "b": 1}', "text")):
        reply = await client.post("/api/areas", content=body, headers={"content-type": "application/json"})
        assert reply.status_code == 422
        assert reply.json()["errors"][0]["field"] == field


def test_who_has_not_signed_in_may_send_little_and_terrain_is_a_file() -> None:
    assert most_bytes("/api/session") == most_bytes("/api/invitation/accept") == bodies.ENTERING_BYTES
    assert most_bytes("/api/terrain") is None
    assert most_bytes("/api/maps/coverage") == most_bytes("/api/nothing") == bodies.JSON_BYTES


async def test_a_body_that_stands_still_is_answered(monkeypatch) -> None:
    monkeypatch.setattr(bodies, "STALL_S", 0.05)
    sent: list[dict] = []

    async def app(scope, receive, send) -> None:
        raise AssertionError("it is not called")

    async def receive() -> dict:
        if not sent:
            sent.append({})
            return {"type": "http.request", "body": b"{", "more_body": True}
        return await asyncio.Future()

    async def send(message) -> None:
        sent.append(message)

    headers = [(b"content-type", b"application/json; charset=utf-8")]
    await Bodies(app)({"type": "http", "path": "/api/session", "headers": headers}, receive, send)
    assert sent[1]["status"] == 408
    assert b"body_too_slow" in sent[2]["body"]
