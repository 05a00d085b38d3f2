"""Bearings from anyone: reported by a phone, a station or a script, and taken back."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response
from pydantic import AfterValidator, AwareDatetime, Field, StringConstraints

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.services import Services
from backend.auth.principal import Principal
from backend.events import BearingMeasured
from backend.kraken import KrakenRefused, read_kraken
from backend.names import seen
from backend.reasons.search import KrakenUnreadable
from backend.search.errors import MissionInputError
from backend.search.reported import ReportedBearing, on_our_clock
from backend.spec import Id, Model, Place

router = APIRouter(prefix="/api/missions/{mission_id}", tags=["missions"], responses=PROBLEM_RESPONSES)

BearingId = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{8,64}$")]
Who = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=40, pattern=r"^[^\x00-\x1f]*$"),
    AfterValidator(seen),
]


class BearingReport(Model):
    """A bearing somebody took. bearing_id: made by the sender, so that the same one sent twice counts once.

    by: who took it, where there are no accounts; else the name of whoever is signed in, or of the token, counts.
    emitter_id None: the search's only emitter. bearing_deg: from true north, at `place`. sigma_deg: its standard
    deviation, compass included. snr_db: how loud it was. taken_at_utc None: just now.
    """

    bearing_id: BearingId
    by: Who | None = None
    emitter_id: Id | None = None
    place: Place
    bearing_deg: float = Field(ge=0, le=360, allow_inf_nan=False)
    sigma_deg: float = Field(default=12.0, ge=1, le=60, allow_inf_nan=False)
    snr_db: float | None = Field(default=None, ge=-50, le=150, allow_inf_nan=False)
    taken_at_utc: AwareDatetime | None = None


class BearingTaken(Model):
    """already: it was there before. by: whose it is now."""

    bearing_id: str
    emitter_id: str
    by: str
    already: bool
    seq: int


@router.post("/bearings", status_code=201, responses={200: {"model": BearingTaken}})
async def report_bearing(
    mission_id: MissionId, report: BearingReport, services: ServicesDep, principal: PrincipalDep, response: Response
) -> BearingTaken:
    """Add a bearing to a search, in flight or not. It disturbs no craft: the next place is planned with it."""
    taken = report.taken_at_utc
    reported = ReportedBearing(
        bearing_id=report.bearing_id,
        by=_who(principal, report.by),
        place=report.place,
        bearing_deg=report.bearing_deg,
        sigma_deg=report.sigma_deg,
        taken_at_s=services.wall() if taken is None else taken.timestamp(),
        emitter_id=report.emitter_id,
        snr_db=report.snr_db,
    )
    return await _taken(services, mission_id, reported, response)


async def _taken(services: Services, mission_id: str, reported: ReportedBearing, response: Response) -> BearingTaken:
    report = on_our_clock(reported, services.now(), services.wall())
    recorded, already = await services.missions.reports.add(mission_id, report)
    if already:
        response.status_code = 200
    fact = recorded.event
    assert isinstance(fact, BearingMeasured)
    by = getattr(fact.source, "name", "")
    return BearingTaken(
        bearing_id=fact.bearing_id, emitter_id=fact.emitter_id, by=by, already=already, seq=recorded.seq
    )


@router.post(
    "/bearings/kraken",
    status_code=201,
    responses={200: {"model": BearingTaken}},
    openapi_extra={"requestBody": {"required": True, "content": {"text/csv": {"schema": {"type": "string"}}}}},
)
async def report_kraken(
    mission_id: MissionId, request: Request, services: ServicesDep, principal: PrincipalDep, response: Response
) -> BearingTaken:
    """Add a bearing of a KrakenSDR: the text of its DOA_value.html (CSV), or one of its JSON records."""
    body = await request.body()
    try:
        reported = read_kraken(body, services.wall())
    except KrakenRefused as error:
        raise MissionInputError(KrakenUnreadable(str(error)), "body") from error
    return await _taken(services, mission_id, replace(reported, by=_who(principal, reported.by)), response)


@router.delete("/bearings/{bearing_id}", status_code=204)
async def take_back_bearing(
    mission_id: MissionId,
    bearing_id: Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$")],
    services: ServicesDep,
    principal: PrincipalDep,
) -> None:
    """Leave out a bearing that was reported; it stays in the journal. A machine takes back its own only."""
    of_anybody = principal.scope is None
    await services.missions.reports.take_back(mission_id, bearing_id, principal.name, of_anybody)


@router.post("/bearings/{bearing_id}/restore", status_code=204)
async def restore_bearing(
    mission_id: MissionId,
    bearing_id: Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$")],
    services: ServicesDep,
    principal: PrincipalDep,
) -> None:
    """Count a bearing again that the same person, or the same machine, took back."""
    await services.missions.reports.restore(mission_id, bearing_id, principal.name)


class Reporter(Model):
    """by: whose bearings, as in BearingReport. muted: they do not count, those to come too."""

    by: Who | None = None
    muted: bool


@router.put("/reporter", status_code=204)
async def mute_reporter(
    mission_id: MissionId, reporter: Reporter, services: ServicesDep, principal: PrincipalDep
) -> None:
    """Stop counting one's own bearings, or count them again. Whoever controls the search does it for others."""
    await services.missions.reports.mute(mission_id, _who(principal, reporter.by), reporter.muted)


def _who(principal: Principal, said: str | None) -> str:
    """Nobody who is signed in, and no machine, speaks in another's name."""
    return said if principal.local and said is not None else principal.name
