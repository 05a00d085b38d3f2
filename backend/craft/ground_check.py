"""What the checklist says of the ground: is it known below the whole flight, and does the vehicle agree about home?"""

from __future__ import annotations

from shapely import Point

from backend.events import CheckFact, GroundFact
from backend.reasons import Reason, terrain
from backend.search.task import SearchTask

HOME_DIFFERS_M = 15.0
"""More than a GPS altitude is usually off by."""
WHOLE = 1 - 1e-6
AT_HOME_M = 1.0


def ground_checks(task: SearchTask) -> tuple[CheckFact, ...]:
    """One line, or two when terrain and autopilot differ about home. Terrain is never asked for: what is not known is
    said, and ways over it are refused."""
    ground = task.ground
    if ground.terrain is None:
        return (_line(False, terrain.NoTerrain()),)
    flown_over = task.fence.union(Point(0.0, 0.0).buffer(AT_HOME_M))
    share, highest = ground.known_share(flown_over), ground.highest_in(flown_over)
    found = [_line(False, terrain.TerrainPartly(100.0 * share))]
    if share >= WHOLE and highest is not None:
        above_home = highest - ground.home_amsl_m
        found = [_line(True, terrain.TerrainCovers(ground.terrain.spacing_m, above_home))]
    home = ground.home_by_terrain_m
    if home is not None and abs(home - ground.home_amsl_m) > HOME_DIFFERS_M:
        found.append(_line(False, terrain.HomeHeightDiffers(home, ground.home_amsl_m)))
    return tuple(found)


def knows_nothing(task: SearchTask) -> bool:
    """The terrain lies elsewhere: it says nothing about this flight."""
    return task.ground.home_by_terrain_m is None and task.ground.known_share(task.fence) == 0.0


def ground_fact(task: SearchTask) -> GroundFact | None:
    """None: flat."""
    found = task.ground.terrain
    if found is None:
        return None
    return GroundFact(
        digest=found.digest, sources=[*found.sources], spacing_m=found.spacing_m, home_m=task.ground.home_by_terrain_m
    )


def _line(ok: bool, reason: Reason) -> CheckFact:
    return CheckFact(name="terrain", ok=ok, reason=reason, blocking=False)
