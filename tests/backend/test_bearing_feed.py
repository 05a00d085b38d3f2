"""Bearings by real UDP: what a sender may say, and that a hostile one costs nothing but a counted refusal."""

from __future__ import annotations

import asyncio
import json
import logging
import socket
from dataclasses import dataclass, field

import pytest

from backend.bearing_feed import (
    BURST,
    LARGEST_BYTES,
    MOST_REFUSED,
    BearingFeed,
    DatagramRefused,
    open_feed,
    read_datagram,
)
from backend.reasons.refusals import MissionOver
from backend.search.errors import MissionConflict
from backend.search.reported import ReportedBearing
from hardware.readings import Place

NOW_S = 1_700_000_000.0
GOOD = {
    "type": "BEARING",
    "bearing_type": "absolute",
    "latitude": 50.6,
    "longitude": 7.2,
    "bearing": 123.0,
    "source": "yagi-1",
    "timestamp": NOW_S - 3.0,
    "confidence": 80.0,
    "raw_doa": [0.0] * 360,
}


def datagram(**changes: object) -> bytes:
    return json.dumps(GOOD | changes).encode()


def test_a_datagram_of_horus_programs_is_a_bearing() -> None:
    report = read_datagram(datagram(), NOW_S)
    assert (report.by, report.place, report.bearing_deg) == ("yagi-1", Place(50.6, 7.2), 123.0)
    assert report.taken_at_s == NOW_S - 3.0
    assert read_datagram(datagram(sigma=6), NOW_S).sigma_deg == 6.0
    without = {key: value for key, value in GOOD.items() if key not in ("source", "timestamp")}
    bare = read_datagram(json.dumps(without).encode(), NOW_S)
    assert (bare.by, bare.taken_at_s) == ("udp", NOW_S)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "not JSON"),
        (b"\xff\x00\x80", "not JSON"),
        (b"[" * 20_000, "not JSON"),
        (b"[1, 2]", "BEARING"),
        (b'{"type": "PAYLOAD_SUMMARY"}', "BEARING"),
        (datagram(bearing_type="relative"), "absolute"),
        (datagram(latitude=float("nan")), "latitude is no number"),
        (datagram(latitude=1e999), "latitude is no number"),
        (datagram(latitude=True), "latitude is no number"),
        (datagram(latitude=10**400), "latitude is no number"),
        (datagram(longitude="7.2"), "longitude is no number"),
        (datagram(longitude=200), "between -180 and 180"),
        (datagram(bearing=None), "bearing is no number"),
        (datagram(bearing=720), "between 0 and 360"),
        (datagram(sigma=0), "sigma"),
        (datagram(source={"a": 1}), "source is no text"),
        (datagram(emitter_id=7), "emitter_id is no text"),
        (datagram(emitter_id="a\n2026 ERROR fire"), "emitter_id is no emitter's id"),
        (datagram(raw_doa="x" * LARGEST_BYTES), "bytes"),
    ],
)
def test_whatever_else_comes_is_refused_and_says_why(data: bytes, says: str) -> None:
    with pytest.raises(DatagramRefused, match=says):
        read_datagram(data, NOW_S)


def test_a_source_writes_nothing_into_a_log_but_its_name() -> None:
    assert read_datagram(datagram(source="a\n2026 ERROR \x1b[31mfire" + "x" * 90), NOW_S).by.isprintable()
    assert len(read_datagram(datagram(source="x" * 900), NOW_S).by) == 40
    assert read_datagram(datagram(source="\n"), NOW_S).by == "udp"


@dataclass
class Search:
    """Takes what comes; `over`: has ended."""

    over: bool = False
    taken: list[ReportedBearing] = field(default_factory=list)
    clock_s: float = 0.0

    async def add(self, report: ReportedBearing) -> None:
        if self.over:
            raise MissionConflict(MissionOver())
        self.taken.append(report)

    def feed(self) -> BearingFeed:
        return BearingFeed(self.add, lambda: NOW_S, lambda: self.clock_s)


async def until(true) -> None:
    async with asyncio.timeout(30.0):
        while not true():  # noqa: ASYNC110 (what a socket brings is seen by looking)
            await asyncio.sleep(0.005)


async def test_a_real_sender_is_heard_among_noise(caplog: pytest.LogCaptureFixture) -> None:
    search = Search()
    feed = search.feed()
    async with open_feed(feed, "127.0.0.1", 0) as address:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for data in (b"noise", datagram(), b'{"type": "BEARING"}', datagram(source="kraken-2", bearing=200)):
                sender.sendto(data, address)
            await until(lambda: feed.taken == 2 and feed.refused == 2)
    assert [(one.by, one.bearing_deg) for one in search.taken] == [("yagi-1", 123.0), ("kraken-2", 200.0)]
    assert len([r for r in caplog.records if "is refused" in r.message]) == 1, "the second refusal is only counted"


async def test_a_station_that_stands_still_counts_once_a_minute() -> None:
    """Its errors are the same each time: ten bearings would make the belief surer than it may be."""
    search = Search()
    feed = search.feed()
    for second in range(0, 90, 10):
        search.clock_s = float(second)
        feed.datagram_received(datagram(bearing=120.0 + second / 10.0), ("192.0.2.1", 1))
    search.clock_s = 91.0
    feed.datagram_received(datagram(latitude=50.601), ("192.0.2.1", 1))
    running = asyncio.create_task(feed.run())
    await until(lambda: feed.taken == 3)
    running.cancel()
    assert [one.bearing_deg for one in search.taken] == [120.0, 126.0, 123.0]
    assert feed.refused == 7


async def test_a_flood_of_one_sender_leaves_room_for_others(caplog: pytest.LogCaptureFixture) -> None:
    search = Search()
    feed = search.feed()
    with caplog.at_level(logging.WARNING):
        for number in range(1_000):
            feed.datagram_received(datagram(source=f"flood-{number}"), ("192.0.2.66", 1))
        feed.datagram_received(datagram(source="honest"), ("192.0.2.1", 1))
    running = asyncio.create_task(feed.run())
    await until(lambda: feed.taken == BURST + 1)
    running.cancel()
    assert search.taken[-1].by == "honest"
    assert feed.refused == 1_000 - BURST
    assert len(caplog.records) == 1
    search.clock_s = 60.0
    feed.datagram_received(b"x", ("192.0.2.66", 1))
    assert f"{feed.refused - 2} more were refused" in caplog.records[-1].message


async def test_health_tells_what_was_refused_of_whom_and_keeps_little_of_many() -> None:
    search = Search(over=True)
    feed = search.feed()
    async with open_feed(feed, "127.0.0.1", 0) as address:
        for number in range(500):
            feed.datagram_received(b"noise", (f"10.0.{number // 250}.{number % 250}", 1))
        feed.datagram_received(b"noise", ("192.0.2.1", 1))
        feed.datagram_received(datagram(source="yagi-1"), ("192.0.2.1", 1))
        await until(lambda: feed.refused == 502)
        told = feed.health()
    assert (told.host, told.port, told.taken, told.refused) == (*address, 0, 502)
    assert len(told.senders) == MOST_REFUSED
    newest = told.senders[0]
    assert (newest.address, newest.name, newest.refused) == ("192.0.2.1", "yagi-1", 2)
    assert (newest.reason, newest.at_utc.timestamp()) == (MissionOver(), NOW_S)
    assert [one.name for one in told.senders[1:]] == [None] * (MOST_REFUSED - 1)


async def test_a_search_that_has_ended_refuses_and_the_feed_goes_on() -> None:
    search = Search(over=True)
    feed = search.feed()
    running = asyncio.create_task(feed.run())
    feed.datagram_received(datagram(), ("192.0.2.1", 1))
    await until(lambda: feed.refused == 1)
    search.over = False
    feed.datagram_received(datagram(), ("192.0.2.1", 1))
    await until(lambda: feed.taken == 1)
    running.cancel()
    assert [one.by for one in search.taken] == ["yagi-1"], "what was not taken keeps no later one out"


async def test_a_port_that_is_taken_is_said_in_one_sentence() -> None:
    async with open_feed(Search().feed(), "127.0.0.1", 0) as (host, port):
        with pytest.raises(ValueError, match=f"UDP port {port}: .*; choose another"):
            async with open_feed(Search().feed(), host, port):
                pass
