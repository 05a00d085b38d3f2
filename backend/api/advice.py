"""Where people and cars listen next: advice that nobody has to follow. It needs no craft and disturbs none."""

from __future__ import annotations

from dataclasses import asdict
from datetime import UTC, datetime

from fastapi import APIRouter
from pydantic import Field

from backend.api.dependencies import MissionId, ServicesDep
from backend.api.map_files import in_thread
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.ways import ways_folder
from backend.reasons import Reason
from backend.search.advice import Along, Going
from backend.spec import Id, LonLat, Model, Place

router = APIRouter(prefix="/api/missions/{mission_id}", tags=["planning"], responses=PROBLEM_RESPONSES)


class AdviceRequest(Model):
    """place: where whoever asks is. speed_m_s: how fast they get on, on foot or in a car. emitter_id None: the first
    that is not localized. hops: with a craft carried along, which is flown straight up at each place and
    turned once. on_roads: in a car; where roads were uploaded, only along them."""

    place: Place
    speed_m_s: float = Field(default=1.3, ge=0.2, le=30, allow_inf_nan=False)
    emitter_id: Id | None = None
    hops: bool = False
    on_roads: bool = False


class HopAnswer(Model):
    """At the place: straight up to altitude_m above the ground there, one turn, straight down."""

    altitude_m: float
    up_s: float
    turn_s: float
    down_s: float


class AdviceAnswer(Model):
    """localized: nothing is left to be done, the rest is None. place: where to listen next, away_m and bearing_deg
    (from true north) as the crow flies. along: what the way keeps to; "straight" where no ways were uploaded: it may be
    none that can be gone. way: from where one stands to the place, way_m along it, move_s how long it takes. unreached:
    the number of those places that no way leads to.

    error_now_m: expected error, error_then_m: about what one bearing from there leaves of it. expected_time_s,
    time_90_s: until localized if all advice is followed. bearings: how many it knows of; a later one makes it old.
    """

    emitter_id: str
    localized: bool
    given_at_utc: datetime
    bearings: int
    place: Place | None = None
    away_m: float | None = None
    bearing_deg: float | None = None
    along: Along | None = None
    way: tuple[LonLat, ...] = ()
    way_m: float | None = None
    move_s: float | None = None
    places: int = 0
    unreached: int = 0
    error_now_m: float | None = None
    error_then_m: float | None = None
    expected_time_s: float | None = None
    time_90_s: float | None = None
    reason: Reason | None = None
    hop: HopAnswer | None = None


@router.post("/advice")
async def ask_advice(mission_id: MissionId, request: AdviceRequest, services: ServicesDep) -> AdviceAnswer:
    """Where to listen next with an antenna in the hand. Nothing is recorded, and no craft flies for it."""
    traced = await in_thread("overlay", ways_folder(services).traced, mission_id)
    going = Going(request.speed_m_s, request.hops, request.on_roads, traced)
    async with services.planning:
        emitter_id, bearings, found = await services.missions.questions.advise(
            mission_id, request.place, going, request.emitter_id
        )
    now = datetime.fromtimestamp(services.now(), UTC)
    if found is None:
        return AdviceAnswer(emitter_id=emitter_id, localized=True, given_at_utc=now, bearings=bearings)
    return AdviceAnswer(
        emitter_id=emitter_id,
        localized=False,
        given_at_utc=now,
        bearings=found.bearings,
        place=found.place,
        away_m=found.away_m,
        bearing_deg=found.bearing_deg,
        along=found.course.along,
        way=found.course.points,
        way_m=found.course.length_m,
        move_s=found.course.move_s,
        places=found.course.places,
        unreached=found.course.unreached,
        error_now_m=found.error_now_m,
        error_then_m=found.error_then_m,
        expected_time_s=found.mean_s,
        time_90_s=found.p90_s,
        reason=found.reason,
        hop=None if found.hop is None else HopAnswer.model_validate(asdict(found.hop)),
    )
