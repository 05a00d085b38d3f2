"""The recording is read back by the reference reader."""

from __future__ import annotations

import io
import json
import math

import numpy as np
import pytest
from mcap.reader import make_reader
from narrowing import known
from small_missions import numbered

from backend.events import BeliefUpdated
from backend.search.state import evolve
from backend.wire.mcap_export import mcap


@pytest.fixture(scope="module")
def messages(recorded, tracks) -> list[tuple[str, int, dict]]:
    reader = make_reader(io.BytesIO(mcap(recorded, tracks)), validate_crcs=True)
    return [
        (channel.topic, message.log_time, json.loads(message.data)) for _, channel, message in reader.iter_messages()
    ]


def of(messages, topic: str) -> list[dict]:
    return [content for name, _, content in messages if name == topic]


def test_every_event_is_in_it_at_its_time(messages, recorded) -> None:
    events = [(at, content) for topic, at, content in messages if topic == "/mission/events"]
    assert [content["seq"] for _, content in events] == [record.seq for record in recorded]
    assert [at for at, _ in events] == [round(record.at_utc.timestamp()) * 10**9 for record in recorded]


def test_messages_are_in_time_order(messages) -> None:
    times = [at for _, at, _ in messages]
    assert times == sorted(times)


def test_the_path_leaves_out_what_is_not_known(messages) -> None:
    first, second = of(messages, "/vehicle/fix")
    assert (first["latitude"], first["altitude"]) == (50.6201, 230.0)
    assert "altitude" not in second
    assert of(messages, "/vehicle/state")[1] == {"altitude_relative_m": 31.0}


def test_the_estimate_carries_its_covariance(messages) -> None:
    (fix,) = of(messages, "/estimate/fix")
    matrix = np.array(fix["position_covariance"]).reshape(3, 3)[:2, :2]
    variances, axes = np.linalg.eigh(matrix)
    assert np.sqrt(variances) == pytest.approx([5.0, 20.0])
    east, north = axes[:, 1]
    assert math.degrees(math.atan2(east, north)) % 180 == pytest.approx(30.0)


def test_findings_show_what_was_known_then(messages) -> None:
    (found,) = of(messages, "/findings")
    features = json.loads(found["geojson"])["features"]
    assert sum(feature["properties"]["what"] == "bearing" for feature in features) == 2


def test_the_tools_find_well_known_schemas(recorded, tracks) -> None:
    summary = known(make_reader(io.BytesIO(mcap(recorded, tracks))).get_summary())
    names = {schema.name for schema in summary.schemas.values()}
    assert {"foxglove.LocationFix", "foxglove.GeoJSON"} <= names
    assert all(json.loads(schema.data)["type"] == "object" for schema in summary.schemas.values())


def test_a_mission_of_one_event_is_a_recording_too(recorded) -> None:
    summary = known(make_reader(io.BytesIO(mcap(recorded[:1], {}))).get_summary())
    assert known(summary.statistics).message_count == 1


def test_findings_name_the_emitter_when_there_are_several(of_two_emitters) -> None:
    reader = make_reader(io.BytesIO(mcap(of_two_emitters, {})), validate_crcs=True)
    (found,) = [json.loads(m.data) for _, c, m in reader.iter_messages() if c.topic == "/findings"]
    features = json.loads(found["geojson"])["features"]
    assert {f["properties"]["emitter"] for f in features if f["properties"]["what"] == "bearing"} == {"fox & <hound>"}


def topics(content: bytes) -> dict[str, list[dict]]:
    found: dict[str, list[dict]] = {}
    for _, channel, message in make_reader(io.BytesIO(content)).iter_messages():
        found.setdefault(channel.topic, []).append(json.loads(message.data))
    return found


def test_the_prior_is_no_fix(of_the_prior) -> None:
    found = topics(mcap(of_the_prior, {}))
    assert "/estimate/fix" not in found
    (shown,) = found["/findings"]
    assert '"estimate"' not in shown["geojson"]


def test_each_craft_and_each_emitter_has_topics_of_its_own_where_there_are_several(of_two_emitters, tracks) -> None:
    belief = next(record.event for record in of_two_emitters if isinstance(record.event, BeliefUpdated))
    of_tag = belief.model_copy(update={"emitter_id": "tag", "bearings": 1})
    recorded = numbered([*(record.event for record in of_two_emitters), of_tag])
    found = topics(mcap(recorded, {**tracks, "craft-2": tracks["craft-1"]}))
    assert set(found) == {
        "/mission/events",
        "/vehicle/craft-1/fix",
        "/vehicle/craft-1/state",
        "/vehicle/craft-2/fix",
        "/vehicle/craft-2/state",
        "/estimate/fox/fix",
        "/estimate/tag/fix",
        "/findings/fox",
        "/findings/tag",
    }
    (of_fox,) = found["/findings/fox"]
    shown = [feature["properties"] for feature in json.loads(of_fox["geojson"])["features"]]
    assert {properties.get("emitter") for properties in shown} == {None, "fox & <hound>"}
    assert {properties["what"] for properties in shown} == {"area", "place", "bearing", "estimate", "c95"}


def test_a_mission_is_folded_once_however_many_beliefs_it_has(recorded, monkeypatch) -> None:
    """At each of them all before was folded again: 480 took 89 seconds, 640 more than a process may."""
    folded: list[int] = []

    def counting(state, event, at_s):
        folded.append(1)
        return evolve(state, event, at_s)

    for module in ("mcap_export", "export_facts"):
        monkeypatch.setattr(f"backend.wire.{module}.evolve", counting)
    belief = next(record.event for record in recorded if isinstance(record.event, BeliefUpdated))
    many = numbered([*(record.event for record in recorded), *[belief] * 50])
    assert len(topics(mcap(many, {}))["/findings"]) == 51
    assert len(folded) == len(many)
