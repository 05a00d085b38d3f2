"""Makes the scenes of views, each piece of work done once: beliefs are folded once, what stands still is kept."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from backend.ports import TrackPoint
from backend.scene.colours import PALETTES
from backend.scene.composition import compose, middle_and_extent, story_belief
from backend.scene.content import Content, Story, VehicleMark, content, flown_path, read_story, vehicle_mark
from backend.scene.flight import moving
from backend.scene.items import Scene
from backend.scene.relief import relief_around
from backend.scene.sources import SceneSource
from backend.search.errors import MissionInputError
from backend.search.ground import Ground
from backend.terrain import Terrain
from backend.wire.scene import SceneRequest
from planner.belief.grid import GridBelief

BELIEFS_KEPT = 32

BeliefKey = tuple[str, str, int, tuple[str, ...]]
"""Mission, emitter, specification, bearings."""

MOVING_LAYERS = frozenset({"path", "vehicle"})


@dataclass(frozen=True)
class Take:
    """One scene of a view, and what it was made from. `live`: the mission flies, its vehicle is drawn where it is."""

    mission_id: str
    request: SceneRequest
    story: Story
    content: Content
    scene: Scene
    live: bool


class Composer:
    """Shared by all views. Heavy work runs in threads; numpy and the planner's kernels let others run meanwhile."""

    def __init__(self, source: SceneSource) -> None:
        self._source = source
        self._beliefs: OrderedDict[BeliefKey, GridBelief | None] = OrderedDict()
        self._terrain: tuple[str, Terrain | None] | None = None

    async def take(self, mission_id: str, request: SceneRequest) -> Take | None:
        """The whole scene, composed again. None when there is nothing to show yet."""
        recorded = await self._source.read(mission_id)
        track = await self._source.track(mission_id)
        story = await asyncio.to_thread(read_story, recorded, request.seq)
        if story is None:
            return None
        live = request.seq is None and mission_id == self._source.flying()
        now = self.now() if live else None
        belief = None if "belief" in request.hidden else await self._belief(story)
        terrain = await self._ground(story)
        shown, scene = await asyncio.to_thread(_compose, story, track, now, belief, request, terrain)
        return Take(mission_id, request, story, shown, scene, live)

    def now(self) -> TrackPoint | None:
        """The vehicle as last heard; None when its place or height is not known."""
        heard = self._source.telemetry()
        if heard.position is None or heard.altitude_relative_m is None:
            return None
        return TrackPoint(
            at_s=self._source.now_s(),
            lat_deg=heard.position.lat,
            lon_deg=heard.position.lon,
            altitude_amsl_m=float("nan") if heard.altitude_amsl_m is None else heard.altitude_amsl_m,
            altitude_relative_m=heard.altitude_relative_m,
            heading_deg=float("nan") if heard.heading_deg is None else heard.heading_deg,
            battery_percent=heard.battery_percent,
            mode=heard.mode,
        )

    def moved(self, take: Take, now: TrackPoint) -> Take:
        """The same scene with the vehicle where it is now and the path up to there; cheap enough for every tick."""
        mark = vehicle_mark(take.story.frame, now)
        if mark is None:
            return take
        path = _longer(take.content.path, mark)
        shown = replace(take.content, path=path, vehicle=mark)
        palette = PALETTES[take.request.theme]
        moved = [item for item in moving(shown, palette, take.scene.extent_m) if item.layer not in take.request.hidden]
        names = {item.name for item in moved}
        still = [item for item in take.scene.items if item.layer not in MOVING_LAYERS and item.name not in names]
        return replace(take, content=shown, scene=replace(take.scene, items=(*still, *moved)))

    async def _ground(self, story: Story) -> Terrain | None:
        """Keeps that of the last digest asked for: the scene is built again at each event."""
        flown_over = story.state.search.ground
        if flown_over is None:
            return None
        if self._terrain is None or self._terrain[0] != flown_over.digest:
            self._terrain = (flown_over.digest, await self._source.ground(flown_over.digest))
        return self._terrain[1]

    async def _belief(self, story: Story) -> GridBelief | None:
        """None when the specification makes no sense (a draft far from any home)."""
        emitter, search = story.emitter, story.state.search
        spec = search.mission
        key = (story.mission_id, emitter.emitter_id, hash(spec.model_dump_json()), search.behind(emitter.emitter_id))
        if key not in self._beliefs:
            self._beliefs[key] = await asyncio.to_thread(_belief_or_none, story)
            while len(self._beliefs) > BELIEFS_KEPT:
                self._beliefs.popitem(last=False)
        self._beliefs.move_to_end(key)
        return self._beliefs[key]


def _belief_or_none(story: Story) -> GridBelief | None:
    try:
        return story_belief(story)
    except MissionInputError:
        return None


def _compose(
    story: Story,
    track: Sequence[TrackPoint],
    now: TrackPoint | None,
    belief: GridBelief | None,
    request: SceneRequest,
    terrain: Terrain | None = None,
) -> tuple[Content, Scene]:
    ground = Ground(story.frame, story.state.search.home_amsl_m, terrain)
    shown = content(story, track, now)
    shown = replace(shown, relief=relief_around(ground, *middle_and_extent(shown)))
    if now is not None:
        shown = replace(shown, path=flown_path(story.frame, track))
    return shown, compose(shown, belief, request.hidden, request.belief_height_m, request.theme)


def _longer(path: np.ndarray, mark: VehicleMark) -> np.ndarray:
    """The path with one more point when the vehicle moved by half a metre."""
    here = np.array([[mark.x, mark.y, mark.z]])
    if len(path) and float(np.linalg.norm(path[-1] - here[0])) < 0.5:
        return path
    return np.concatenate((path, here))
