"""What `make containers` does while a box is being killed, without any box."""

from __future__ import annotations

import httpx
import pytest

from tests.containers.flight import Fact, Flight, phase
from tests.containers.fly import Watch, left_out

HOLD: Fact = {"kind": "phase_changed", "after": "hold"}


def mission(*replies: httpx.Response | Exception) -> Flight:
    """That gives these replies, one for each question."""
    waiting = list(replies)

    def reply(_: httpx.Request) -> httpx.Response:
        given = waiting.pop(0)
        if isinstance(given, Exception):
            raise given
        return given

    return Flight(httpx.AsyncClient(base_url="https://box", transport=httpx.MockTransport(reply)), "m")


def page(*facts: Fact, more: bool = False) -> httpx.Response:
    return httpx.Response(200, json={"events": [{"seq": n, "event": f} for n, f in enumerate(facts, 1)], "more": more})


async def test_a_server_that_is_away_is_asked_again() -> None:
    flight = mission(httpx.ConnectError("refused"), httpx.Response(502), page(HOLD, more=True), page(HOLD))
    assert await flight.until(lambda facts: phase(facts) == "hold") == [HOLD, HOLD]


async def test_a_refusal_is_not_waited_out() -> None:
    with pytest.raises(RuntimeError, match="401"):
        await mission(httpx.Response(401, text="sign in")).until(lambda facts: True)


async def test_a_step_that_fails_is_no_figure() -> None:
    watch = Watch()
    async with watch.timed("up"):
        pass
    with pytest.raises(RuntimeError):
        async with watch.timed("restore"):
            raise RuntimeError
    assert [(figure.name, figure.unit) for figure in watch.figures] == [("up", "s")]


def test_a_bill_of_materials_names_what_is_for_more_than_development() -> None:
    lock = {
        "packages": {
            "": {"name": "page"},
            "node_modules/vite": {"dev": True},
            "node_modules/maplibre-gl": {},
            "node_modules/maplibre-gl/node_modules/@types/geojson": {},
        }
    }
    bill = {"components": [{"name": "maplibre-gl"}]}
    assert left_out(bill, lock) == ["@types/geojson"]
    assert left_out({"components": [*bill["components"], {"name": "@types/geojson"}]}, lock) == []
