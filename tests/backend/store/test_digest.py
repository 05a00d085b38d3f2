"""What the line of a mission says, fact by fact."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

from facts import SECOND, TWO_SPEC, bearing, belief

from backend.events import (
    BearingExcluded,
    BearingIncluded,
    Event,
    MissionDrafted,
    MissionEdited,
    MissionLabelled,
    PersonSource,
    Recorded,
    SourceMuteChanged,
)
from backend.spec import FIRST_EMITTER, MissionSpec
from backend.store.digest import MissionDigest, fold

DRAFTED = MissionDrafted(spec=TWO_SPEC)
EVE = PersonSource(name="eve")


def line(*facts: Event, before: MissionDigest | None = None) -> MissionDigest:
    first = 1 if before is None else before.last_seq + 1
    at_utc = datetime(2026, 5, 1, tzinfo=UTC)
    return fold(before, [Recorded(seq=first + n, mission_id="m", at_utc=at_utc, event=f) for n, f in enumerate(facts)])


def taken(number: int, emitter_id: str = FIRST_EMITTER, source: PersonSource = EVE) -> Event:
    return bearing(number).model_copy(update={"emitter_id": emitter_id, "source": source})


def left_out(number: int, kind: type[BearingExcluded] | type[BearingIncluded] = BearingExcluded) -> Event:
    reason = {"reason": ""} if kind is BearingExcluded else {}
    named = {"emitter_id": FIRST_EMITTER, "bearing_id": bearing(number).bearing_id, "by": "a"}
    return kind.model_validate(named | reason)


def muted(is_muted: bool) -> SourceMuteChanged:
    return SourceMuteChanged(source=EVE, muted=is_muted, by="a")


def test_bearings_of_a_muted_source_do_not_count() -> None:
    ben = PersonSource(name="ben")
    facts = [DRAFTED, taken(1, source=ben), taken(2), taken(3, SECOND), taken(4, SECOND, ben)]
    first = line(*facts, belief(2), belief(2, emitter_id=SECOND))
    assert first.bearings == 4
    mute = line(muted(True), belief(1), belief(1, emitter_id=SECOND), before=first)
    assert mute.bearings == 2
    one_fewer = line(left_out(2), belief(1), before=mute)
    assert one_fewer.bearings == 2, "its source was left out already"
    late = line(taken(5), belief(1), before=one_fewer)
    assert late.bearings == 2
    again = line(muted(False), belief(2), belief(2, emitter_id=SECOND), before=late)
    assert again.bearings == 4, "all but the one that was left out by itself"
    assert line(left_out(2, BearingIncluded), belief(3), before=again).bearings == 5


def test_no_number_of_bearings_is_below_none() -> None:
    assert line(DRAFTED, left_out(1), left_out(1)).bearings == 0


def test_an_emitter_that_is_no_longer_looked_for_takes_its_bearings_with_it() -> None:
    alone = MissionEdited(spec=TWO_SPEC.model_copy(update={"emitters": TWO_SPEC.emitters[:1]}))
    edited = line(DRAFTED, taken(1), taken(2, SECOND), alone)
    assert (edited.emitters, edited.bearings) == (1, 1)


def test_a_mission_from_before_goes_on_as_it_was() -> None:
    before = replace(line(DRAFTED, taken(1), taken(2, SECOND)), counted=None, spec_name=None)
    after = line(taken(3), belief(2), left_out(3), edited(name="x"), before=before)
    assert (after.bearings, after.counted, after.name, after.spec_name) == (2, None, "x", "x")


def edited(**changes: object) -> MissionEdited:
    return MissionEdited(spec=MissionSpec.model_validate(TWO_SPEC.model_dump() | changes))


def test_a_label_stays_until_the_specification_is_given_another_name() -> None:
    labelled = line(DRAFTED, MissionLabelled(name="Owls by the river", tags=[], notes="", by="a"))
    higher = line(edited(flight={"altitude_relative_m": 33}), before=labelled)
    assert higher.name == "Owls by the river"
    assert line(edited(name="Foxes"), before=higher).name == "Foxes"
