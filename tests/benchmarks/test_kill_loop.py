from __future__ import annotations

from typing import Any

from tests.benchmarks.kill_loop import last_beliefs


def told(*events: dict[str, Any]) -> list[dict[str, Any]]:
    return [{"event": event} for event in events]


def bearing(name: str) -> dict[str, Any]:
    return {"kind": "bearing_measured", "emitter_id": "a", "bearing_id": name}


def leg(name: str) -> dict[str, Any]:
    return {"kind": "heard_on_the_way", "emitter_id": "a", "leg_id": name}


def belief(emitter: str, digest: str) -> dict[str, Any]:
    return {"kind": "belief_updated", "emitter_id": emitter, "digest": digest}


def test_each_emitter_has_a_belief_of_its_own() -> None:
    events = told(bearing("b-1"), belief("a", "of a"), belief("b", "of b"))
    assert last_beliefs(events) == {"a": (("b-1",), "of a"), "b": (("b-1",), "of b")}
    assert last_beliefs(events[::-1]) == {}


def test_a_belief_is_not_compared_once_a_leg_or_a_bearing_came_after_it() -> None:
    before = told(bearing("b-1"), belief("a", "first"), leg("l-1"))
    assert last_beliefs(before) == {}
    assert last_beliefs([*before, *told(belief("a", "second"))]) == {"a": (("b-1", "l-1"), "second")}
