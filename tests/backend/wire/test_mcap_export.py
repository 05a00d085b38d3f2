"""The recording is read back by the reference reader."""

from __future__ import annotations

import io
import json
import math

import numpy as np
import pytest
from mcap.reader import make_reader
from narrowing import known

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
