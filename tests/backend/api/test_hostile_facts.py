"""Facts in a bundle that no Crossfix records: the event is named, and no page is broken by it."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest
from bundles import FLOWN, SOUND, repacked

from backend.api import library
from backend.events import BearingMeasured, BeliefUpdated, MissionLabelled, PhaseChanged, Recorded, TruthNoted
from backend.events.review import VariantKept
from backend.reasons.flight import Ordered
from backend.reasons.request import BundleFactWrong
from backend.spec import Place
from backend.store.brought import BundleRefused, read_bundle
from backend.store.brought_facts import unfit
from tests.golden.test_journals import NAMES, recorded


def seq_of(kind: str) -> int:
    return next(r.seq for r in FLOWN if r.event.kind == kind)


ESTIMATED = next(r.seq for r in FLOWN if isinstance(r.event, BeliefUpdated) and r.event.estimate is not None)
BEARING = next(r.event for r in FLOWN if isinstance(r.event, BearingMeasured))


def with_fact(seq: int, **changes: Any) -> bytes:
    def change(text: bytes) -> bytes:
        told = json.loads(text)
        told["events"][seq - 1]["event"] |= changes
        return json.dumps(told).encode()

    return repacked(SOUND, "mission.json", change)


def with_estimate(**changes: Any) -> bytes:
    estimate = FLOWN[ESTIMATED - 1].event.model_dump(mode="json")["estimate"]
    return with_fact(ESTIMATED, estimate=estimate | changes)


def region(*rings: list[list[float]]) -> dict[str, Any]:
    return {"type": "Polygon", "coordinates": list(rings)}


def with_more(fact: Any) -> bytes:
    def change(text: bytes) -> bytes:
        told = json.loads(text)
        last = told["events"][-1]
        event = fact if isinstance(fact, dict) else fact.model_dump(mode="json")
        return json.dumps(
            told | {"events": [*told["events"], last | {"seq": last["seq"] + 1, "event": event}]}
        ).encode()

    return repacked(SOUND, "mission.json", change)


def excluded(bearing_id: str, kind: str = "bearing_excluded") -> dict[str, Any]:
    return {"kind": kind, "emitter_id": BEARING.emitter_id, "bearing_id": bearing_id, "by": "a"} | (
        {"reason": "b"} if kind == "bearing_excluded" else {}
    )


def labelled(name: str, *tags: str) -> MissionLabelled:
    return MissionLabelled(name=name, tags=list(tags), notes="", by="a")


HERE = [7.2, 50.6]
GHOST = PhaseChanged(craft_id="ghost", before="ground", after="flying", reason=Ordered("start", "a"))
MORE = len(FLOWN) + 1


@pytest.mark.parametrize(
    ("content", "fault", "seq"),
    [
        (with_estimate(c95=region([HERE, HERE])), "region", ESTIMATED),
        (with_estimate(c95=region([])), "region", ESTIMATED),
        (with_estimate(c95=region()), "region", ESTIMATED),
        (with_estimate(c95={"type": "MultiPolygon", "coordinates": [[]]}), "region", ESTIMATED),
        (with_estimate(lat=95.0, lon=500.0), "place", ESTIMATED),
        (with_estimate(expected_rmse_m=-1.0), "spread", ESTIMATED),
        (with_fact(ESTIMATED, bearings=-2), "spread", ESTIMATED),
        (with_fact(seq_of("bearing_measured"), sigma_deg=0.0), "spread", seq_of("bearing_measured")),
        (with_fact(seq_of("bearing_measured"), sweep_id='=HYPERLINK("x")'), "id", seq_of("bearing_measured")),
        (with_more(excluded("nope")), "unknown_bearing", MORE),
        (with_more(excluded("nope", "bearing_included")), "unknown_bearing", MORE),
        (with_more(BEARING), "bearing_twice", MORE),
        (with_more(GHOST), "not_started", MORE),
        (with_more(labelled("\u202egpj.exe")), "name", MORE),
        (with_more(labelled("fox", "\u202etag")), "name", MORE),
        (with_more(VariantKept.model_validate({"name": "\u202ev", "wanted": {}, "by": "a"})), "name", MORE),
    ],
)
def test_a_fact_that_no_crossfix_records_is_refused_and_named(content: bytes, fault: Any, seq: int) -> None:
    with pytest.raises(BundleRefused) as refused:
        read_bundle(content)
    assert refused.value.reason == BundleFactWrong(fault, seq)


@pytest.mark.parametrize("content", [with_more(excluded(BEARING.bearing_id)), with_more(labelled("שלום", "räuber"))])
def test_what_people_do_after_a_flight_comes_in(content: bytes) -> None:
    assert len(read_bundle(content).rows) == MORE


@pytest.mark.parametrize("name", NAMES)
def test_what_our_own_servers_recorded_is_refused_at_no_age(name: str) -> None:
    assert unfit(recorded(name)) is None


async def test_one_mission_that_cannot_be_reckoned_with_takes_the_calibration_from_nobody(
    client, services, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    truth = TruthNoted(
        emitter_id=BEARING.emitter_id, place=Place(lat=50.6, lon=7.2), accuracy_m=None, how="map", by="a"
    )
    for mission_id in ("sound", "odd"):
        await services.journal.append(mission_id, [*(record.event for record in FLOWN), truth])

    def reckoned(sound: Callable[[list[Recorded]], Any]) -> Callable[[list[Recorded]], Any]:
        def told(facts: list[Recorded]) -> Any:
            if facts[0].mission_id == "odd":
                raise ValueError("a ring of two points")
            return sound(facts)

        return told

    monkeypatch.setattr(library, "told", reckoned(library.told))
    answer = await client.get("/api/calibration")
    assert (answer.status_code, answer.json()["missions"]) == (200, 1)
    assert "mission odd is left out" in caplog.text
