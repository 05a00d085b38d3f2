"""Bearings by UDP, as Project Horus' programs and others send them: JSON objects of type BEARING (see `read_datagram`).

Nobody signs in on UDP: whoever can send to the port can add bearings to the search that flies. It is off unless a port
is set, and listens to this machine only unless a host is.
"""

from __future__ import annotations

import asyncio
import json
import logging
import math
import re
from collections import OrderedDict
from collections.abc import AsyncGenerator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import cast
from uuid import uuid4

from backend.auth.buckets import Buckets, neighbourhood
from backend.kraken import FEWEST_COLUMNS, KrakenRefused, read_kraken
from backend.reasons import Reason
from backend.reasons import datagrams as reasons
from backend.reasons.search import KrakenUnreadable
from backend.search.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.search.reported import ReportedBearing
from backend.wire.health import BearingsUdpHealth, RefusedSender
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.reason import Reason as AnyReason
from planner.reason import ReasonedError, sentence_of

log = logging.getLogger("crossfix.bearings")

LARGEST_BYTES = 32 * 2**10
"""With the raw directions of a whole circle in it."""
BURST, EVERY_S = 20.0, 0.2
"""Datagrams of one address: BURST of them at once, then one every EVERY_S seconds."""
SAID_EVERY_S = 10.0
SAME_PLACE_M = 25.0
ANEW_S = 60.0
"""A direction finder that stands still sends the same errors again and again: from one place, one bearing a minute."""
MOST_WAITING = 64
MOST_SOURCES = 256
SIGMA_DEG = 12.0
IDENTIFIER = re.compile(r"[A-Za-z0-9_-]{1,40}")
"""Of an emitter, as in a specification: no sender writes anything else into a log or a page."""
MOST_REFUSED = 8
"""Addresses of which it is known what was refused last: a sender may invent as many as it likes."""


class DatagramRefused(ReasonedError, ValueError):
    """Why a datagram is no bearing that counts."""


@dataclass(frozen=True, slots=True)
class _Refused:
    """What was refused of an address. name: what the last one calls itself. at_s: of the last, UTC epoch seconds."""

    number: int
    name: str | None
    reason: Reason
    at_s: float


def read_datagram(data: bytes, now_s: float) -> ReportedBearing:
    """{"type": "BEARING", "bearing_type": "absolute", "latitude", "longitude", "bearing", and optionally "source",
    "timestamp" (epoch seconds), "sigma" (degrees), "emitter_id"}; what else stands in it is not looked at.

    A confidence is not: its scale is each program's own. A relative bearing is refused: nobody tells the car's heading.
    Raises DatagramRefused.
    """
    if len(data) > LARGEST_BYTES:
        raise DatagramRefused(reasons.DatagramTooLong(len(data), LARGEST_BYTES))
    try:
        content: object = json.loads(data)
    except (ValueError, RecursionError):
        raise DatagramRefused(reasons.DatagramNoBearing("json")) from None
    told = cast(dict[str, object], content) if isinstance(content, dict) else {}
    if told.get("type") != "BEARING":
        raise DatagramRefused(reasons.DatagramNoBearing("bearing"))
    if told.get("bearing_type") != "absolute":
        raise DatagramRefused(reasons.DatagramNotAbsolute())
    lat, lon = _number(told, "latitude", -90.0, 90.0), _number(told, "longitude", -180.0, 180.0)
    taken_at_s = _number(told, "timestamp", 0.0, 1e11) if "timestamp" in told else now_s
    emitter_id = told.get("emitter_id")
    if emitter_id is not None and not isinstance(emitter_id, str):
        raise DatagramRefused(reasons.DatagramValueUnreadable("emitter_id", "text"))
    if emitter_id is not None and IDENTIFIER.fullmatch(emitter_id) is None:
        raise DatagramRefused(reasons.DatagramValueUnreadable("emitter_id", "emitter"))
    return ReportedBearing(
        bearing_id=str(uuid4()),
        by=_name(told.get("source", "udp")),
        place=Place(lat, lon),
        bearing_deg=_number(told, "bearing", 0.0, 360.0),
        sigma_deg=_number(told, "sigma", 1.0, 60.0) if "sigma" in told else SIGMA_DEG,
        taken_at_s=taken_at_s,
        emitter_id=emitter_id,
    )


def read_any(data: bytes, now_s: float) -> ReportedBearing:
    """A datagram as above, or a record of a KrakenSDR. Raises DatagramRefused."""
    kraken = b'"radioBearing"' in data or (data[:1].isdigit() and data.count(b",") >= FEWEST_COLUMNS - 1)
    if not kraken:
        return read_datagram(data, now_s)
    try:
        return read_kraken(data, now_s)
    except KrakenRefused as refused:
        raise DatagramRefused(KrakenUnreadable(str(refused))) from None


def _number(told: dict[str, object], name: str, low: float, high: float) -> float:
    value = told.get(name)
    try:
        found = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
    except OverflowError:  # a whole number of hundreds of digits
        found = math.nan
    if not math.isfinite(found):
        raise DatagramRefused(reasons.DatagramValueUnreadable(name, "number"))
    if not low <= found <= high:
        raise DatagramRefused(reasons.DatagramValueImpossible(name, found, low, high))
    return found


def _name(source: object) -> str:
    """Printable, so that no sender writes into a log or a page what it likes."""
    if not isinstance(source, str):
        raise DatagramRefused(reasons.DatagramValueUnreadable("source", "text"))
    return "".join(c for c in source if c.isprintable()).strip()[:40] or "udp"


Add = Callable[[ReportedBearing], Awaitable[object]]
"""To the search that flies. Raises DatagramRefused when none does, and what `Reports.add` raises."""


@dataclass(slots=True)
class BearingFeed(asyncio.DatagramProtocol):
    """now: the clock of the world outside, UTC epoch seconds; steady: one that never runs backwards, s. address: where
    it listens, once it does."""

    add: Add
    now: Callable[[], float]
    steady: Callable[[], float]
    address: tuple[str, int] = ("", 0)
    taken: int = 0
    refused: int = 0
    _queue: asyncio.Queue[tuple[str, ReportedBearing]] = field(default_factory=lambda: asyncio.Queue(MOST_WAITING))
    _buckets: Buckets = field(default_factory=lambda: Buckets(BURST, EVERY_S))
    _last: dict[str, tuple[Place, float]] = field(default_factory=dict[str, tuple[Place, float]])
    _refused: OrderedDict[str, _Refused] = field(default_factory=OrderedDict[str, _Refused])
    _said_at_s: float = -math.inf
    _unsaid: int = 0

    def health(self) -> BearingsUdpHealth:
        """For whoever looks after the server."""
        senders = [
            RefusedSender(
                address=address,
                name=last.name,
                refused=last.number,
                reason=last.reason,
                at_utc=datetime.fromtimestamp(last.at_s, UTC),
            )
            for address, last in reversed(self._refused.items())
        ]
        host, port = self.address
        return BearingsUdpHealth(host=host, port=port, taken=self.taken, refused=self.refused, senders=senders)

    def datagram_received(self, data: bytes, addr: tuple[object, ...]) -> None:
        """From the loop; never raises."""
        key, now_s = neighbourhood(str(addr[0])), self.steady()
        if self._buckets.wait_s(key, now_s) > 0.0:
            self._refuse(key, None, reasons.SenderTooBusy())
            return
        self._buckets.take(key, now_s)
        try:
            report = read_any(data, self.now())
            self._check_fresh(report, now_s)
            self._queue.put_nowait((key, report))
        except DatagramRefused as refused:
            self._refuse(key, None, refused.reason)
        except asyncio.QueueFull:
            self._refuse(key, None, reasons.TooManyWait())

    def _check_fresh(self, report: ReportedBearing, now_s: float) -> None:
        last = self._last.get(report.by)
        if last is not None:
            place, at_s = last
            away_m = math.hypot(*LocalFrame(place).to_enu(report.place))
            if away_m < SAME_PLACE_M and now_s - at_s < ANEW_S:
                raise DatagramRefused(reasons.SameErrorsAgain(report.by, ANEW_S))
        if len(self._last) >= MOST_SOURCES and report.by not in self._last:
            self._last.pop(next(iter(self._last)))
        self._last[report.by] = (report.place, now_s)

    async def run(self) -> None:
        """Until it is cancelled: one bearing after another into the search."""
        while True:
            address, report = await self._queue.get()
            try:
                await self.add(report)
                self.taken += 1
            except (DatagramRefused, MissionInputError, MissionConflict, MissionNotFound) as refused:
                self._last.pop(report.by, None)  # what the search did not take keeps no later one out
                self._refuse(address, report.by, refused.reason)
            except Exception:
                log.exception("a bearing of %s was not taken", report.by)

    def _refuse(self, address: str, name: str | None, reason: AnyReason) -> None:
        """Logged at most every ten seconds; what was not logged is counted."""
        self.refused += 1
        before = self._refused.pop(address, None)
        number = 1 if before is None else before.number + 1
        self._refused[address] = _Refused(number, name, reason, self.now())
        if len(self._refused) > MOST_REFUSED:
            self._refused.popitem(last=False)
        now_s = self.steady()
        if now_s - self._said_at_s < SAID_EVERY_S:
            self._unsaid += 1
            return
        more = f" ({self._unsaid} more were refused since the last line)" if self._unsaid else ""
        log.warning("a datagram of %s is refused: %s%s", name or address, sentence_of(reason), more)
        self._said_at_s, self._unsaid = now_s, 0


@asynccontextmanager
async def open_feed(feed: BearingFeed, host: str, port: int) -> AsyncGenerator[tuple[str, int]]:
    """Listening address while inside. Raises ValueError when it cannot be had."""
    loop = asyncio.get_running_loop()
    try:
        transport, _ = await loop.create_datagram_endpoint(lambda: feed, local_addr=(host, port))
    except OSError as error:
        raise ValueError(
            f"cannot listen for bearings on {host}, UDP port {port}: {error.strerror}; choose another with "
            "CROSSFIX_BEARINGS_UDP_HOST and CROSSFIX_BEARINGS_UDP_PORT"
        ) from error
    running = asyncio.create_task(feed.run())
    try:
        name = transport.get_extra_info("sockname")
        feed.address = str(name[0]), int(name[1])
        yield feed.address
    finally:
        transport.close()
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
