"""The whole scene of a mission at one moment: a pure function from what is known to what is drawn."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import shapely

from backend.events import Recorded
from backend.ports import TrackPoint
from backend.scene.belief_surface import belief_surface, peak_height_m
from backend.scene.colours import PALETTES, Theme
from backend.scene.content import Content, Story, content, read_story
from backend.scene.findings import findings
from backend.scene.flight import flight
from backend.scene.items import Item, Scene
from backend.scene.surroundings import surroundings
from backend.search.together import together
from backend.wire.scene import SceneLayer
from planner.belief.grid import GridBelief


def scene_items(
    recorded: Sequence[Recorded],
    belief: GridBelief | None,
    track: Sequence[TrackPoint] = (),
    vehicle: TrackPoint | None = None,
    *,
    upto_seq: int | None = None,
    hidden: Collection[SceneLayer] = (),
    belief_height_m: float | None = None,
    theme: Theme = "dark",
) -> Scene | None:
    """The scene after event `upto_seq` (None: the last). None when there is nothing drafted to show.

    recorded: all events of one mission in order. belief: the one of that moment about `Story.emitter`, None: not drawn.
    track: the flown path in time order. vehicle: where it is now; None: where the track ends.
    """
    story = read_story(recorded, upto_seq)
    if story is None:
        return None
    return compose(content(story, track, vehicle), belief, hidden, belief_height_m, theme)


def story_belief(story: Story) -> GridBelief:
    """The belief about the emitter that the story shows, rebuilt from its bearings exactly as the flight computed it.

    Before any bearing it is the prior. Raises MissionInputError when the specification makes no sense. Heavy: call it
    off the event loop.
    """
    search, name = story.state.search, story.emitter.emitter_id
    task = together(search.mission, story.frame.origin, name).about(search, name)
    return task.planning_belief(task.planner_bearings(story.emitter.bearings))


def middle_and_extent(shown: Content) -> tuple[tuple[float, float], float]:
    """m ENU and m: of what there is to see."""
    west, south, east, north = shapely.union_all([shown.area, shown.fence]).bounds
    return ((west + east) / 2, (south + north) / 2), max(east - west, north - south)


def compose(
    shown: Content,
    belief: GridBelief | None,
    hidden: Collection[SceneLayer] = (),
    belief_height_m: float | None = None,
    theme: Theme = "dark",
) -> Scene:
    """belief None: not known. belief_height_m: of the surface's peak; None: by the extent. hidden: layers left out."""
    palette = PALETTES[theme]
    middle, extent = middle_and_extent(shown)
    height = 0.0
    items: list[Item] = []
    if belief is not None:
        height = belief_height_m or peak_height_m(belief, extent)
        surface = belief_surface(belief, height)
        items += [surface] if surface is not None else []
    items += surroundings(shown, palette, middle, extent)
    items += findings(shown, palette, extent, height)
    items += flight(shown, palette, extent)
    unwanted = set(hidden)
    return Scene(
        mission_id=shown.mission_id,
        items=tuple(item for item in items if item.layer not in unwanted),
        centre=(*middle, 0.0),
        extent_m=extent,
        background=palette.sky,
    )
