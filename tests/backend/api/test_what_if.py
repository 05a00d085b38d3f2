"""A flown decision taken again: the same with nothing changed, another with another sensor; nothing is recorded."""

from __future__ import annotations

import base64
import json
import math
import struct
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from backend.events import (
    BearingExcluded,
    BearingMeasured,
    CraftSource,
    ImportSource,
    MissionDrafted,
    MissionStarted,
    RecordingImported,
    SweepRejected,
    TruthNoted,
)
from backend.events.review import Supposition, VariantKept
from backend.search.antenna import antenna_fact
from backend.search.localization import localization
from backend.spec import EmitterSpec, MissionSpec, Polygon
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern, pattern_json
from hardware.frame import LocalFrame
from hardware.readings import Place, Sweep
from hardware.reasons.sweep import NoDirection

HOME = Place(lat=50.6, lon=7.2)
FRAME = LocalFrame(HOME)
EMITTER = (30.0, 120.0)


def corner(x: float, y: float) -> tuple[float, float]:
    point = FRAME.to_geo(x, y)
    return point.lon, point.lat


RING = [corner(-150, 0), corner(150, 0), corner(150, 200), corner(-150, 200), corner(-150, 0)]
SPEC = MissionSpec(name="meadow", area=Polygon(coordinates=[RING]))
TASK = localization(SPEC, HOME)
YAGI = load_pattern(SMALL_YAGI)
OWN = CraftSource(craft_id="craft-1")


def started(**more: Any) -> MissionStarted:
    return MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0", **more)


def bearing(number: int, x: float, y: float) -> BearingMeasured:
    return BearingMeasured(
        emitter_id="emitter-1",
        source=OWN,
        bearing_id=f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=TASK.place(x, y),
        altitude_amsl_m=140.0,
        bearing_deg=math.degrees(math.atan2(EMITTER[0] - x, EMITTER[1] - y)) % 360,
        sigma_deg=7.0,
        quality=0.9,
        peaks=[],
        snr_db=20.0,
        drift_m=0.2,
        binned_db=[0.0] * 180,
        fitted_db=[0.0] * 180,
    )


BEARINGS = [bearing(1, 0, 0), bearing(2, 140, 60), bearing(3, 140, 150)]


@pytest.fixture
async def flown(services) -> str:
    events = [MissionDrafted(spec=SPEC), started()]
    for number, fact in enumerate(BEARINGS, start=1):
        events += [fact, TASK.belief_fact(BEARINGS[:number])[0]]
    await services.journal.append("m1", events)
    return "m1"


def sweep_of(fact: BearingMeasured) -> Sweep:
    """One turn in a quiet field with an emitter at the fact's bearing, heard by the small Yagi over the nose."""
    nose = np.arange(0.0, 360.0, 1.0)
    return Sweep(
        at_s=nose / 30.0,
        heading_deg=nose,
        power_db=-60.0 + YAGI.gain_at(fact.bearing_deg - nose),
        frequency_hz=SPEC.emitters[0].frequency_hz,
        position=fact.place,
        altitude_amsl_m=140.0,
        noise_floor_db=-110.0,
    )


@pytest.fixture
async def heard(flown, services) -> str:
    """The flight with its power samples."""
    for fact in BEARINGS:
        await services.journal.save_sweep(
            flown, fact.sweep_id, "craft-1", "emitter-1", fact.place_number, 1, sweep_of(fact)
        )
    return flown


def turned_deg(told: dict) -> list[float]:
    """How far each sweep's bearing lies from the flown one, clockwise."""
    flown = {fact.sweep_id: fact.bearing_deg for fact in BEARINGS}
    return [(s["bearing_deg"] - flown[s["sweep_id"]] + 180.0) % 360.0 - 180.0 for s in told["sweeps"]]


def pattern_file(frequency_hz: float | None, beams: int) -> dict[str, str]:
    angle = list(range(0, 360, 5))
    gain = [20.0 * math.log10(0.1 + abs(math.cos(math.radians(beams * a / 2.0)))) for a in angle]
    content = {"format": "crossfix antenna pattern", "unit": "dB", "relative_bearing_deg": angle, "gain": gain}
    return {"filename": "mine.json", "text": json.dumps(content | {"name": "mine", "frequency_hz": frequency_hz})}


async def ask(client, mission_id: str, **changed) -> dict:
    answer = await client.post(f"/api/missions/{mission_id}/what-if", json={"bearings": 2} | changed)
    assert answer.status_code == 200, answer.text
    return answer.json()


async def test_with_nothing_changed_it_is_what_was_flown(client, flown, services):
    before = len(await services.journal.read(flown))
    told = await ask(client, flown)
    fact, _ = TASK.belief_fact(BEARINGS[:2])
    assert told["belief"]["digest"] == fact.digest
    assert [step["bearings"] for step in told["steps"]] == [0, 1, 2]
    for step in told["steps"][1:]:
        assert step["expected_rmse_m"] == step["flown_expected_rmse_m"]
        assert step["localized"] == step["flown_localized"]
    assert told["plan"]["place_number"] == 3
    assert told["plan"]["candidates"]
    assert len(await services.journal.read(flown)) == before


async def test_a_worse_sensor_would_have_known_less(client, flown):
    worse = await ask(client, flown, sigma_deg=25.0)
    last = worse["steps"][-1]
    assert last["expected_rmse_m"] > 1.5 * last["flown_expected_rmse_m"]
    assert worse["belief"]["localized"] is False


async def test_another_planner_chooses_by_its_own_reason(client, flown):
    rollout, fisher = await ask(client, flown), await ask(client, flown, method="base_policy", base_policy="fisher")
    assert fisher["plan"]["reason"] != rollout["plan"]["reason"]
    assert fisher["plan"]["rollouts"] == 0


async def test_the_frame_holds_the_belief_that_would_have_been(client, flown):
    told = await ask(client, flown, bearings=3, sigma_deg=3.0)
    frame = base64.b64decode(told["frame_base64"])
    (length,) = struct.unpack_from("<I", frame)
    header = json.loads(frame[4 : 4 + length])
    assert (header["mission_id"], header["emitter_id"], header["seq"]) == (flown, "emitter-1", 0)
    assert (header["bearings"], header["encoding"]) == (3, "u8-log-zlib")


async def test_each_emitter_of_a_mission_is_asked_about_by_itself(client, services):
    spec = SPEC.model_copy(update={"emitters": [EmitterSpec(), EmitterSpec(emitter_id="tag", frequency_hz=150e6)]})
    task = localization(spec, HOME, "tag")
    of_tag = BEARINGS[0].model_copy(update={"emitter_id": "tag"})
    await services.journal.append("m2", [MissionDrafted(spec=spec), started(), of_tag, task.belief_fact([of_tag])[0]])
    told = await ask(client, "m2", bearings=1, emitter_id="tag")
    assert (told["belief"]["emitter_id"], told["belief"]["digest"]) == ("tag", task.belief_fact([of_tag])[0].digest)
    assert told["plan"]["emitter_id"] == "tag"
    for emitter_id, pattern in (("fox", None), ("emitter-1", None)):
        nothing = {"bearings": 1, "emitter_id": emitter_id, "pattern": pattern}
        answer = await client.post("/api/missions/m2/what-if", json=nothing)
        assert answer.status_code == 404
    wrong = {"bearings": 1, "emitter_id": "tag", "pattern": pattern_file(868.3e6, beams=1)}
    answer = await client.post("/api/missions/m2/what-if", json=wrong)
    assert answer.json()["reason"]["code"] == "pattern_of_other_frequency"


async def test_an_excluded_bearing_counts_neither_then_nor_now(client, flown, services):
    without = [BEARINGS[0], BEARINGS[2]]
    excluded = BearingExcluded(emitter_id="emitter-1", bearing_id="b2", by="operator", reason="")
    await services.journal.append(flown, [excluded, TASK.belief_fact(without)[0]])
    told = await ask(client, flown)
    assert told["belief"]["digest"] == TASK.belief_fact(without)[0].digest


@pytest.mark.parametrize(
    ("mission_id", "body", "status"),
    [("m1", {"bearings": 4}, 404), ("m2", {"bearings": 1}, 404), ("m1", {"bearings": 1, "sigma_deg": 0}, 422)],
)
async def test_what_makes_no_sense_is_refused(client, flown, mission_id, body, status):
    answer = await client.post(f"/api/missions/{mission_id}/what-if", json=body)
    assert answer.status_code == status
    assert answer.json()["title"]


async def test_the_stored_sweeps_are_evaluated_again_with_the_antenna_as_it_was(client, heard):
    told = await ask(client, heard, bearings=3, offset_to_nose_deg=0.0)
    assert [s["bearing_id"] for s in told["sweeps"]] == ["b1", "b2", "b3"]
    assert turned_deg(told) == pytest.approx([0.0, 0.0, 0.0], abs=0.5)
    assert told["antenna"] == {"name": YAGI.name, "offset_to_nose_deg": 0.0}


async def test_another_mounting_turns_every_bearing_and_moves_the_place(client, heard):
    as_flown, askew = await ask(client, heard), await ask(client, heard, offset_to_nose_deg=-25.0)
    assert as_flown["antenna"] is None
    assert turned_deg(askew) == pytest.approx([-25.0, -25.0], abs=0.5)
    assert askew["belief"]["digest"] != as_flown["belief"]["digest"]


async def test_the_mounting_is_that_of_the_antenna_that_flew_whatever_the_server_has_now(client, services):
    turned = replace(YAGI, name="flown", offset_to_nose_deg=90.0)
    events = [
        MissionDrafted(spec=SPEC),
        started(antenna=antenna_fact(turned)),
        BEARINGS[0],
        TASK.belief_fact(BEARINGS[:1])[0],
    ]
    await services.journal.append("m1", events)
    await services.journal.save_sweep("m1", BEARINGS[0].sweep_id, "craft-1", "emitter-1", 1, 1, sweep_of(BEARINGS[0]))
    told = await ask(client, "m1", bearings=1, offset_to_nose_deg=0.0)
    assert told["antenna"] == {"name": "flown", "offset_to_nose_deg": 0.0}
    assert turned_deg(told) == pytest.approx([0.0], abs=0.5)


async def test_another_pattern_is_flown_with_what_the_mission_took_off_its_bearings(client, services):
    sensor = SPEC.sensor.model_copy(update={"bearing_offset_deg": 20.0})
    flown = replace(YAGI, name="flown", offset_to_nose_deg=YAGI.offset_to_nose_deg - 20.0)
    events = [
        MissionDrafted(spec=SPEC.model_copy(update={"sensor": sensor})),
        started(antenna=antenna_fact(flown)),
        BEARINGS[0],
        TASK.belief_fact(BEARINGS[:1])[0],
    ]
    await services.journal.append("m1", events)
    await services.journal.save_sweep("m1", BEARINGS[0].sweep_id, "craft-1", "emitter-1", 1, 1, sweep_of(BEARINGS[0]))
    told = await ask(client, "m1", bearings=1, pattern={"filename": "yagi.json", "text": pattern_json(YAGI)})
    assert told["antenna"]["offset_to_nose_deg"] == YAGI.offset_to_nose_deg - 20.0
    assert turned_deg(told) == pytest.approx([-20.0], abs=0.5)


@pytest.mark.parametrize("imported_first", [False, True])
async def test_a_recording_beside_the_flight_has_no_correction_and_takes_none_from_it(client, services, imported_first):
    """Whichever came last: the flown bearings have the mission's offset taken off, a recording's never had it."""
    sensor = SPEC.sensor.model_copy(update={"bearing_offset_deg": 20.0})
    flown = replace(YAGI, name="flown", offset_to_nose_deg=YAGI.offset_to_nose_deg - 20.0)
    theirs = BEARINGS[1].model_copy(update={"source": ImportSource(recording_id="r")})
    recording = RecordingImported(
        emitter_id="emitter-1", recording_id="r", filename="turn.csv", by="anna", recorded_at_utc=None,
        sweep_ids=[str(theirs.sweep_id)], remarks=[], antenna=antenna_fact(YAGI),
    )  # fmt: skip
    flight, brought = [started(antenna=antenna_fact(flown)), BEARINGS[0]], [recording, theirs]
    order = [*brought, *flight] if imported_first else [*flight, *brought]
    await services.journal.append("m1", [MissionDrafted(spec=SPEC.model_copy(update={"sensor": sensor})), *order])
    for fact, craft_id in ((BEARINGS[0], "craft-1"), (theirs, None)):
        number = fact.place_number
        await services.journal.save_sweep("m1", fact.sweep_id, craft_id, "emitter-1", number, 1, sweep_of(fact))
    told = await ask(client, "m1", bearings=2, pattern={"filename": "yagi.json", "text": pattern_json(YAGI)})
    assert sorted(turned_deg(told)) == pytest.approx([-20.0, 0.0], abs=0.5)


async def test_through_an_antenna_that_it_does_not_look_like_a_sweep_tells_nothing(client, heard):
    told = await ask(client, heard, pattern=pattern_file(None, beams=5))
    assert [s["kind"] for s in told["sweeps"]] == ["sweep_rejected", "sweep_rejected"]
    assert [step["bearings"] for step in told["steps"]] == [0, 1, 2]
    assert told["steps"][2]["flown_expected_rmse_m"] is not None
    assert told["belief"]["bearings"] == 0


async def test_a_rejected_sweep_that_is_heard_now_spares_the_next_attempt(client, services):
    first, again = BEARINGS[0].model_copy(update={"sweep_id": "s0"}), BEARINGS[0]
    rejected = SweepRejected(
        emitter_id="emitter-1",
        source=OWN,
        sweep_id="s0",
        place_number=1,
        attempt=1,
        quality=0.5,
        reason=NoDirection(),
        place=first.place,
        binned_db=[],
        fitted_db=[],
    )
    events = [MissionDrafted(spec=SPEC), rejected, again, TASK.belief_fact([again])[0]]
    await services.journal.append("m1", events)
    for fact, attempt in ((first, 1), (again, 2)):
        await services.journal.save_sweep("m1", fact.sweep_id, "craft-1", "emitter-1", 1, attempt, sweep_of(fact))
    as_flown = await ask(client, "m1", bearings=1)
    assert [(s["kind"], s["sweep_id"]) for s in as_flown["sweeps"]] == [
        ("sweep_rejected", "s0"),
        ("bearing_measured", "s1"),
    ]
    turned = await ask(client, "m1", bearings=1, offset_to_nose_deg=0.0)
    assert [(s["kind"], s["sweep_id"]) for s in turned["sweeps"]] == [("bearing_measured", "s0")]


@pytest.mark.parametrize(
    ("changed", "status", "reason"),
    [
        ({"offset_to_nose_deg": 10.0}, 409, {"code": "samples_not_stored", "place_number": 1}),
        ({"pattern": pattern_file(150e6, beams=1)}, 422, {"code": "pattern_of_other_frequency"}),
        (
            {"pattern": {"filename": "mine.json", "text": "[" * 100_000}},
            422,
            {"code": "not_a_pattern", "why": "json"},
        ),
        ({"pattern": {"filename": "a.csv", "text": "0, 1\n90, 2"}}, 422, {"code": "too_few_points", "points": 2}),
    ],
)
async def test_an_antenna_that_cannot_be_tried_is_refused_with_its_reason(client, flown, changed, status, reason):
    answer = await client.post(f"/api/missions/{flown}/what-if", json={"bearings": 2} | changed)
    assert answer.status_code == status, answer.text
    assert reason.items() <= answer.json()["reason"].items()


async def courses(client, mission_id: str) -> dict[str | None, dict[str, Any]]:
    reply = await client.get(f"/api/missions/{mission_id}/courses")
    assert reply.status_code == 200, reply.text
    return {course["name"]: course for course in reply.json()["courses"]}


async def keep(client, mission_id: str, name: str, **wanted: Any) -> int:
    return (await client.put(f"/api/missions/{mission_id}/variants/{name}", json=wanted)).status_code


async def test_variants_stand_by_name_beside_a_mission_that_never_changes(client, flown, services):
    place = TASK.place(*EMITTER)
    truth = TruthNoted(emitter_id="emitter-1", place=place, accuracy_m=1.0, how="map", by="Ada")
    await services.journal.append(flown, [truth])
    original = (await courses(client, flown))[None]
    assert [point["bearings"] for point in original["points"]] == [1, 2, 3]
    assert all(point["error_m"] is not None for point in original["points"])
    assert original["points"][-1]["inside"]

    assert await keep(client, flown, "as flown") == 204
    assert await keep(client, flown, "blunter", sigma_deg=15.0) == 204
    assert await keep(client, flown, "without two", without=["b2"]) == 204
    assert await keep(client, flown, "planner", budget=20, estimator="expected_value") == 204
    found = await courses(client, flown)
    assert list(found) == [None, "as flown", "blunter", "without two", "planner"]
    assert found[None] == original, "the original never changes"
    assert found["as flown"]["points"] == original["points"]
    for flown_point, blunt in zip(original["points"], found["blunter"]["points"], strict=True):
        assert blunt["expected_rmse_m"] > flown_point["expected_rmse_m"]
    assert [point["bearings"] for point in found["without two"]["points"]] == [1, 2]
    assert found["without two"]["points"][1]["t_s"] == original["points"][2]["t_s"], "on the same axis of time"

    assert await keep(client, flown, "blunter", sigma_deg=3.0) == 204
    again = await courses(client, flown)
    assert again["blunter"]["points"][0]["expected_rmse_m"] < found["blunter"]["points"][0]["expected_rmse_m"]
    assert (await client.delete(f"/api/missions/{flown}/variants/blunter")).status_code == 204
    assert list(await courses(client, flown)) == [None, "as flown", "without two", "planner"]


async def test_a_bearing_left_out_of_a_question_is_not_believed(client, flown):
    base = f"/api/missions/{flown}/what-if"
    asked = {"bearings": 3, "method": "base_policy", "base_policy": "ellipse"}
    whole, fewer = [(await client.post(base, json=asked | more)).json() for more in ({}, {"without": ["b1"]})]
    assert (whole["belief"]["bearings"], fewer["belief"]["bearings"]) == (3, 2)
    assert [sweep["sweep_id"] for sweep in fewer["sweeps"]] == ["s2", "s3"]


async def test_a_variant_that_cannot_be_computed_says_why_and_the_others_stand(client, flown):
    """The samples of this flight were not stored, so no other mounting can hear them."""
    assert await keep(client, flown, "turned", offset_to_nose_deg=10.0) == 204
    found = await courses(client, flown)
    assert (found["turned"]["points"], found["turned"]["problem"]["code"]) == ([], "samples_not_stored")
    assert len(found[None]["points"]) == 3


async def test_no_more_variants_than_can_be_compared(client, flown):
    answers = [await keep(client, flown, f"v{number}") for number in range(13)]
    assert answers == [204] * 12 + [409]
    assert await keep(client, flown, "v0", sigma_deg=9.0) == 204, "one that is there may change"
    for wrong in ("%20", "x" * 61, "a%0Ab", "%E2%80%AEgpj", "%E2%80%8B", "v%EF%BF%BF"):
        assert await keep(client, flown, wrong) == 422, wrong


async def test_a_variant_with_a_name_of_before_is_still_told_and_dropped(client, flown, services):
    await services.journal.append(flown, [VariantKept(name="\u202egpj", wanted=Supposition(), by="a")])
    assert "\u202egpj" in await courses(client, flown)
    assert (await client.delete(f"/api/missions/{flown}/variants/%E2%80%AEgpj")).status_code == 204
    assert list(await courses(client, flown)) == [None]


async def test_a_variant_kept_for_one_emitter_is_told_of_the_one_asked_about(client, services):
    two = SPEC.model_copy(update={"emitters": [*SPEC.emitters, EmitterSpec(emitter_id="e2", frequency_hz=869e6)]})
    others = [bearing(n, x, 0.0).model_copy(update={"emitter_id": "e2"}) for n, x in ((4, -50.0), (5, 70.0))]
    await services.journal.append("two", [MissionDrafted(spec=two), started(), bearing(1, -100.0, 0.0), *others])
    assert await keep(client, "two", "of e2", emitter_id="e2") == 204
    for asked, about, taken in (({}, "emitter-1", [1]), ({"emitter": "e2"}, "e2", [1, 2])):
        told = (await client.get("/api/missions/two/courses", params=asked)).json()
        assert (told["emitter_id"], [one["emitter_id"] for one in told["emitters"]]) == (about, ["emitter-1", "e2"])
        _, variant = told["courses"]
        assert (variant["name"], [point["bearings"] for point in variant["points"]]) == ("of e2", taken)
