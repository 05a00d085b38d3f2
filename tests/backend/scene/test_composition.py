"""The whole scene: a pure function of the recorded events and the belief."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeVar

import numpy as np
import pytest
from narrowing import a, known

from backend.scene.composition import scene_items, story_belief
from backend.scene.content import read_story
from backend.scene.items import Label, Lines, Scene, Surface, same
from backend.wire.scene import SceneLayer
from planner.belief.grid import digest

EMITTER = (40.0, 130.0)
T = TypeVar("T")


@pytest.fixture(scope="module")
def belief(recorded):
    return story_belief(known(read_story(recorded)))


@pytest.fixture(scope="module")
def scene(recorded, belief, track) -> Scene:
    return known(scene_items(recorded, belief, track))


def named(kind: type[T], scene: Scene | None, name: str) -> T:
    (found,) = [item for item in known(scene).items if item.name == name]
    return a(kind, found)


def test_the_same_facts_make_the_same_scene(recorded, belief, track, scene) -> None:
    again = known(scene_items(recorded, belief, track))
    assert len(again.items) == len(scene.items)
    assert all(same(one, other) for one, other in zip(scene.items, again.items, strict=True))


def test_the_rebuilt_belief_is_the_one_of_the_flight(recorded, belief) -> None:
    last = [record.event for record in recorded if record.event.kind == "belief_updated"][-1]
    assert digest(belief) == last.digest


def test_names_are_unique_and_everything_can_be_drawn(scene) -> None:
    names = [item.name for item in scene.items]
    assert len(set(names)) == len(names)
    for item in scene.items:
        if isinstance(item, Surface):
            assert len(item.vertices) == len(item.colours) > 0
            assert item.faces.max() < len(item.vertices)
            assert np.isfinite(item.vertices).all()
        elif isinstance(item, Lines):
            assert item.segments.shape == item.colours.shape
            assert item.segments.shape[1:] == (2, 3)
            assert np.isfinite(item.segments).all()
        else:
            assert item.text


def test_every_layer_has_something(scene) -> None:
    layers = {item.layer for item in scene.items}
    assert layers == {
        *("area", "terrain", "fence", "no_fly", "path", "vehicle", "roses", "bearings"),
        *("belief", "c95", "candidates", "estimate", "labels"),
    }


def test_hidden_layers_are_left_out_and_nothing_else(recorded, belief, track, scene) -> None:
    hidden: set[SceneLayer] = {"belief", "labels"}
    left = known(scene_items(recorded, belief, track, hidden=hidden))
    assert [item.name for item in left.items] == [item.name for item in scene.items if item.layer not in hidden]


def test_the_summit_and_the_pin_stand_near_the_emitter(scene) -> None:
    surface, pin = named(Surface, scene, "belief/surface"), named(Lines, scene, "estimate/emitter-1/pin")
    summit = surface.vertices[surface.vertices[:, 2].argmax()]
    assert math.dist(summit[:2], EMITTER) < 15
    assert math.dist(pin.segments[0, 0, :2], EMITTER) < 15
    assert pin.segments[0, 1, 2] > summit[2]


def test_a_bearing_starts_at_its_place_and_height_and_passes_the_emitter(scene) -> None:
    (line,) = named(Lines, scene, "sweeps/1/bearing").segments
    start, end = line[0].astype(float), line[1].astype(float)
    assert start == pytest.approx((0, 20, 40), abs=0.05)
    direction = (end - start)[:2] / np.linalg.norm((end - start)[:2])
    towards = np.array(EMITTER) - start[:2]
    assert abs(direction[0] * towards[1] - direction[1] * towards[0]) < 0.1
    assert not scene_has_inside(end[:2])


def scene_has_inside(point: np.ndarray) -> bool:
    return -150 <= point[0] <= 170 and -10 <= point[1] <= 210


def test_a_rose_reaches_farthest_towards_its_bearing(scene) -> None:
    rim = named(Lines, scene, "sweeps/1/rim").segments[:, 0]
    strongest = rim[np.hypot(rim[:, 0], rim[:, 1] - 20).argmax()]
    wanted = math.degrees(math.atan2(EMITTER[0], EMITTER[1] - 20))
    assert math.degrees(math.atan2(strongest[0], strongest[1] - 20)) == pytest.approx(wanted, abs=1.5)
    assert (rim[:, 2] == 40).all()


def test_older_sweeps_are_fainter(scene) -> None:
    strengths = [named(Surface, scene, f"sweeps/{number}/rose").colours[:, 3].max() for number in (1, 2, 3)]
    assert strengths == sorted(strengths)
    assert strengths[0] < strengths[-1]


def test_the_error_circle_has_the_radius_of_the_expected_error(scene, recorded) -> None:
    fact = [record.event for record in recorded if record.event.kind == "belief_updated"][-1]
    ring = named(Lines, scene, "estimate/emitter-1/error").segments[:, 0]
    centre = ring[:, :2].mean(axis=0)
    radius = np.linalg.norm(ring[:, :2] - centre, axis=1)
    assert radius == pytest.approx(fact.estimate.expected_rmse_m, rel=1e-3)
    assert f"{fact.estimate.expected_rmse_m:.1f} m" in named(Label, scene, "estimate/emitter-1/label").text


def test_survivors_are_larger_than_the_dropped(scene) -> None:
    discs = named(Surface, scene, "candidates/discs")
    corners = discs.vertices.reshape(4, -1, 3)
    radii = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    assert radii[0] == radii.max()
    assert radii[3] == radii.min() or radii[1] == radii.min()
    assert (radii[1:] < radii[0]).all()
    assert "1:23" in named(Label, scene, "next/4/label").text


def test_the_vehicle_stands_where_it_is_and_turns_with_its_heading(recorded, belief, track) -> None:
    now = replace(track[-1], heading_deg=135.0, altitude_relative_m=55.0)
    body = named(Surface, scene_items(recorded, belief, track, now), "vehicle/body")
    assert body.position[2] == 55.0
    assert body.heading_deg == 135.0
    unknown = replace(now, heading_deg=float("nan"))
    assert "heading unknown" in named(Label, scene_items(recorded, belief, track, unknown), "vehicle/label").text


def test_a_draft_shows_its_area_and_prior(recorded) -> None:
    story = known(read_story(recorded, 1))
    draft = known(scene_items(recorded, story_belief(story), upto_seq=1))
    layers = {item.layer for item in draft.items}
    assert {"area", "fence", "belief"} <= layers
    assert not {"vehicle", "path", "roses", "bearings", "estimate", "candidates"} & layers


def test_themes_differ_in_colours_only(recorded, belief, track) -> None:
    dark, light = (known(scene_items(recorded, belief, track, theme=theme)) for theme in ("dark", "light"))
    assert [item.name for item in dark.items] == [item.name for item in light.items]
    assert sum(dark.background) < sum(light.background)
    for one, other in zip(dark.items, light.items, strict=True):
        if isinstance(one, Label):
            again = a(Label, other)
            assert (one.text, one.position) == (again.text, again.position)


def test_nothing_drafted_no_scene() -> None:
    assert scene_items([], None) is None


def test_several_emitters_have_a_pin_each_and_the_belief_is_of_the_first_not_localized(two_emitters) -> None:
    story = known(read_story(two_emitters))
    assert story.emitter.emitter_id == "emitter-2"
    scene = known(scene_items(two_emitters, story_belief(story)))
    labels = [
        a(Label, item).text
        for item in scene.items
        if item.name.startswith("estimate/") and item.name.endswith("/label")
    ]
    assert len(labels) == 1
    assert labels[0].startswith("fox")
    named(Lines, scene, "sweeps/0/bearing")
    named(Lines, scene, "sweeps/1/bearing")
