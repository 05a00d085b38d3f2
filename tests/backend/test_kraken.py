"""Records of KrakenSDR stations: two formats that count the angle in opposite ways, and what hostile ones cost."""

from __future__ import annotations

import json

import pytest

from backend.bearing_feed import DatagramRefused, read_any
from backend.kraken import LARGEST_BYTES, KrakenRefused, read_kraken
from hardware.readings import Place

NOW_S = 1_700_000_000.0
CSV = (
    "1700000000123, 40, 80.5, -31.2, 868300000, UCA, 412, roof, 50.6, 7.2, 350.0, 10.0, GPS, R, R, R, R" + ", 0.1" * 360
)
JSON = {
    "station_id": "roof", "tStamp": 1700000000123, "latitude": "50.6", "longitude": "7.2", "gpsBearing": "350.0",
    "radioBearing": "320", "conf": "80", "power": "-31", "freq": 868300000, "antType": "UCA", "doaArray": "0,1",
}  # fmt: skip


def test_the_csv_counts_clockwise_and_the_json_the_other_way_round() -> None:
    """Both: 40 degrees clockwise of a front that points to 350."""
    for data in (CSV.encode(), json.dumps(JSON).encode()):
        found = read_kraken(data, NOW_S)
        assert found.bearing_deg == pytest.approx(30.0)
        assert (found.by, found.place, found.frequency_hz) == ("roof", Place(50.6, 7.2), 868_300_000.0)
        assert found.taken_at_s == pytest.approx(1_700_000_000.123)


def test_the_compass_counts_when_the_station_says_so() -> None:
    assert read_kraken(CSV.replace("GPS,", "Compass,").encode(), NOW_S).bearing_deg == pytest.approx(50.0)


def test_one_bearing_a_minute_from_one_place() -> None:
    first = read_kraken(CSV.encode(), NOW_S).bearing_id
    soon = read_kraken(CSV.replace("1700000000123", "1700000015123").encode(), NOW_S).bearing_id
    later = read_kraken(CSV.replace("1700000000123", "1700000061123").encode(), NOW_S).bearing_id
    elsewhere = read_kraken(CSV.replace("50.6,", "50.61,").encode(), NOW_S).bearing_id
    assert first == soon
    assert len({first, later, elsewhere}) == 3


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "columns"),
        (b"\xff\xfe", "no text"),
        (b"1,2,3", "Kraken App"),
        (b"{" * 2000, "not JSON"),
        (b"{}", "radioBearing is no number"),
        (json.dumps(JSON | {"radioBearing": "nan"}).encode(), "radioBearing is no number"),
        (json.dumps(JSON | {"radioBearing": True}).encode(), "radioBearing is no number"),
        (json.dumps(JSON | {"latitude": "0.0", "longitude": "0.0"}).encode(), "no GPS fix"),
        (json.dumps(JSON | {"latitude": 91}).encode(), "between -90 and 90"),
        (json.dumps(JSON | {"gpsBearing": None}).encode(), "heading is no number"),
        (CSV.replace(" 40,", " 4e3,").encode(), "between 0 and 360"),
        (b"1" * (LARGEST_BYTES + 1), "are the most"),
    ],
)
def test_what_is_wrong_is_said(data: bytes, says: str) -> None:
    with pytest.raises(KrakenRefused, match=says):
        read_kraken(data, NOW_S)


def test_the_udp_port_takes_both_and_still_refuses_what_is_neither() -> None:
    assert read_any(CSV.encode(), NOW_S).by == "roof"
    assert read_any(json.dumps(JSON).encode(), NOW_S).by == "roof"
    horus = {"type": "BEARING", "bearing_type": "absolute", "latitude": 50, "longitude": 7, "bearing": 3}
    assert read_any(json.dumps(horus).encode(), NOW_S).by == "udp"
    for data in (b"", b"12", b"[1]", b"hello", b'{"radioBearing": 3}'):
        with pytest.raises(DatagramRefused):
            read_any(data, NOW_S)
