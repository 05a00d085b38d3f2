"""A course over time: what was believed after each bearing of a mission, and what its variants would have believed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated

import pymap3d.vincenty
from fastapi import APIRouter, Path
from pydantic import AfterValidator

from backend.api.another_antenna import AnotherAntenna, another_antenna
from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.heavy import apart
from backend.api.missions import stored_mission
from backend.api.problems import PROBLEM_RESPONSES, not_found
from backend.api.review import EmitterId
from backend.api.what_if import SUPPOSED_KINDS, Supposed, suppose
from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    MissionEnded,
    MissionStarted,
    Recorded,
    Supposition,
    TruthNoted,
)
from backend.events.review import VariantName
from backend.mission.review import variants_of
from backend.names import seen
from backend.reasons import Reason
from backend.search.covering import covers
from backend.search.errors import MissionConflict, MissionInputError
from backend.spec import EmitterSpec, Place
from backend.wire.courses import Course, CoursePoint, MissionCourses

router = APIRouter(prefix="/api/missions/{mission_id}", tags=["review"], responses=PROBLEM_RESPONSES)

KINDS = (*SUPPOSED_KINDS, "mission_ended", "truth_noted", "variant_kept", "variant_dropped")
"""The events that the answer depends on."""

Name = Annotated[VariantName, Path(max_length=60)]
SeenName = Annotated[Name, AfterValidator(seen)]
"""One that was kept before is dropped, whatever is in it."""

Wanted = tuple[Supposition, "AnotherAntenna | None", "Reason | None"]


@router.get("/courses")
async def get_courses(mission_id: MissionId, services: ServicesDep, emitter: EmitterId = None) -> MissionCourses:
    """The course of a mission about an emitter (None: the first) and those of its variants about the same, each
    computed from the stored facts."""
    digest = await stored_mission(services, mission_id)
    recorded = await services.journal.read_kinds(mission_id, KINDS)
    wanted: dict[str, Wanted] = {}
    for name, kept in variants_of(recorded).items():
        asked = kept.model_copy(update={"emitter_id": emitter})
        try:
            wanted[name] = asked, await another_antenna(services, mission_id, recorded, asked), None
        except MissionInputError as error:
            wanted[name] = asked, None, error.reason
    async with services.planning:
        found = await apart(services, (1 + len(wanted)) * len(recorded), courses, recorded, wanted, emitter)
    if found is None:
        raise not_found("belief_about", str(emitter))
    emitters, about, ended_s, bearings_s, each = found
    return MissionCourses(
        mission_id=mission_id,
        name=digest.name,
        emitter_id=about,
        emitters=emitters,
        ended_s=ended_s,
        bearings_s=bearings_s,
        courses=each,
    )


@router.put("/variants/{name}", status_code=204)
async def keep_variant(
    mission_id: MissionId, name: SeenName, wanted: Supposition, services: ServicesDep, principal: PrincipalDep
) -> None:
    """Keep a supposition by name beside the mission, which stays as it was flown."""
    await stored_mission(services, mission_id)
    await services.missions.review.keep_variant(mission_id, name, wanted, principal.name)


@router.delete("/variants/{name}", status_code=204)
async def drop_variant(mission_id: MissionId, name: Name, services: ServicesDep, principal: PrincipalDep) -> None:
    """Forget a variant. Nothing happens to a name that is not kept."""
    await stored_mission(services, mission_id)
    await services.missions.review.drop_variant(mission_id, name, principal.name)


def courses(
    recorded: Sequence[Recorded], wanted: Mapping[str, Wanted], emitter_id: str | None
) -> tuple[list[EmitterSpec], str, float | None, list[float], list[Course]] | None:
    """The mission's emitters, the one it is about, end and bearings (s since the start), and the courses: the flown one
    first. None: no such emitter, or nothing is known of it. Heavy: call it off the event loop."""
    flown = suppose(recorded, Supposition(emitter_id=emitter_id), None, None)
    if flown is None:
        return None
    about = flown.task.emitter_id
    began_s = _began_s(recorded)
    at_s = {
        record.event.bearing_id: record.at_utc.timestamp() - began_s
        for record in recorded
        if isinstance(record.event, BearingMeasured)
    }
    truths = [r.event.place for r in recorded if isinstance(r.event, TruthNoted) and r.event.emitter_id == about]
    truth = truths[-1] if truths else None
    said = [
        _point(record.at_utc.timestamp() - began_s, record.event.bearings, record.event, truth)
        for record in recorded
        if isinstance(record.event, BeliefUpdated) and record.event.emitter_id == about and record.event.bearings > 0
    ]
    found = [Course(name=None, wanted=None, points=said)]
    for name, (asked, antenna, problem) in wanted.items():
        points: list[CoursePoint] = []
        if problem is None:
            try:
                points = _points(suppose(recorded, asked, None, antenna), asked, at_s, truth)
            except MissionConflict as error:  # samples that were not stored
                problem = error.reason
        found.append(Course(name=name, wanted=asked, points=points, problem=problem))
    ended = [r.at_utc.timestamp() - began_s for r in recorded if isinstance(r.event, MissionEnded)]
    counted_s = [at_s[fact.bearing_id] for fact in flown.counted]
    return flown.task.mission.emitters, about, ended[-1] if ended else None, counted_s, found


def _began_s(recorded: Sequence[Recorded]) -> float:
    """The start; of a search without a craft its first bearing."""
    first = next((r for r in recorded if isinstance(r.event, MissionStarted)), None) or next(
        (r for r in recorded if isinstance(r.event, BearingMeasured)), recorded[0]
    )
    return first.at_utc.timestamp()


def _points(
    supposed: Supposed | None, wanted: Supposition, at_s: Mapping[str, float], truth: Place | None
) -> list[CoursePoint]:
    """One after each bearing that the variant takes."""
    if supposed is None:
        return []
    after = zip(supposed.counted, supposed.said[1:], strict=True)
    return [
        _point(at_s[fact.bearing_id], then.bearings, then, truth)
        for fact, (then, _) in after
        if fact.bearing_id not in wanted.without
    ]


def _point(t_s: float, bearings: int, then: BeliefUpdated, truth: Place | None) -> CoursePoint:
    estimate = then.estimate
    error_m = inside = None
    if estimate is not None and truth is not None:
        error_m = float(pymap3d.vincenty.vdist(estimate.lat, estimate.lon, truth.lat, truth.lon)[0])
        inside = covers(estimate.c95, truth)
    return CoursePoint(
        t_s=t_s,
        bearings=bearings,
        expected_rmse_m=None if estimate is None else estimate.expected_rmse_m,
        c95_area_m2=None if estimate is None else estimate.c95_area_m2,
        error_m=error_m,
        inside=inside,
        localized=then.localized,
    )
