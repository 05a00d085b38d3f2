"""What the flights of a craft with its antenna taught of its bearings' errors, shown and forgotten."""

from __future__ import annotations

import math
from typing import Annotated

from fastapi import APIRouter, Query

from backend.api.crafts import CraftId
from backend.api.dependencies import ServicesDep
from backend.api.problems import PROBLEM_RESPONSES, not_found
from backend.api.services import Services
from backend.craft.equipment import CraftEquipment
from backend.search.lessons import errors_now, mean_bias
from backend.search.source_priors import prior_in
from backend.spec import SensorSpec
from backend.wire.resources import CompassKnown

router = APIRouter(prefix="/api/crafts", tags=["crafts"], responses=PROBLEM_RESPONSES)


Offset = Annotated[float, Query(ge=-180, le=180, allow_inf_nan=False)]
"""SensorSpec.bearing_offset_deg of the mission that is asked for."""


@router.get("/{craft_id}/compass")
async def compass(craft_id: CraftId, services: ServicesDep, bearing_offset_deg: Offset = 0.0) -> CompassKnown:
    """What the next mission of this craft starts from, with the antenna that it carries now, when this is taken off its
    bearings."""
    return await _known(services, _craft(services, craft_id), bearing_offset_deg)


@router.delete("/{craft_id}/compass")
async def forget_compass(craft_id: CraftId, services: ServicesDep, bearing_offset_deg: Offset = 0.0) -> CompassKnown:
    """Forget all of it: the compass was calibrated, the antenna mounted again. Missions that have started keep what
    they started from."""
    craft = _craft(services, craft_id)
    await services.missions.equipment.lessons.forget(craft.craft_id, craft.pattern.name)
    return await _known(services, craft, bearing_offset_deg)


def _craft(services: Services, craft_id: str) -> CraftEquipment:
    craft = services.missions.equipment.crafts.get(craft_id)
    if craft is None:
        raise not_found("craft", craft_id)
    return craft


async def _known(services: Services, craft: CraftEquipment, offset_deg: float) -> CompassKnown:
    antenna = craft.pattern.name
    lessons = await services.missions.equipment.lessons.of(craft.craft_id, antenna)
    prior = prior_in(errors_now(lessons, SensorSpec(bearing_offset_deg=offset_deg), craft.craft_id, antenna))
    found = mean_bias(lessons, offset_deg)
    return CompassKnown(
        craft_id=craft.craft_id,
        antenna=antenna,
        flights=len(lessons),
        bearings=sum(one.bearings for one in lessons),
        places_known=sum(one.place_known for one in lessons),
        bias_deg=None if found is None else found[0],
        bias_spread_deg=None if found is None else found[1],
        expected_bias_deg=math.degrees(prior.bias_sd),
        sigma_scale=float(prior.scale_weight @ prior.scale),
        outlier_rate=float(prior.rate_weight @ prior.rate),
    )
