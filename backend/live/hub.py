"""Shows what happens to everybody who watches, and waits for nobody.

Events are kept as one text each in a bounded ring a mission; a viewer has a cursor into it and reads the journal when
it fell behind the ring, so no event is ever dropped and a viewer that stands still costs no memory. Values that go
stale (telemetry, sweep progress, status, belief) are slots: the newest wins, and what a viewer missed is counted.
Everything is encoded once for all viewers.
"""

from __future__ import annotations

import asyncio
from collections import OrderedDict, deque
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from itertools import islice
from typing import Literal

from backend.events import Recorded
from backend.live.snapshot import telemetry_message
from backend.ports import SectorShown, Status
from backend.wire.belief_frame import encode_belief
from backend.wire.messages import CraftStatusMessage, EventMessage, SectorMessage, StatusMessage, SweepProgress
from hardware.readings import Telemetry
from planner.belief.grid import GridBelief

RING = 500
FEEDS = 8
STALLED_S = 3.0
PROGRESS_POINTS = 360

SlotKind = Literal["telemetry", "status", "sweep_progress", "belief"]
SlotName = tuple[SlotKind, str]
"""A kind of value, and the craft, the emitter or both that it speaks of ("" for the server's own)."""
STATUS: SlotName = ("status", "")
ReadEvents = Callable[[str, int], Awaitable[list[str]]]
"""Mission, number -> the events after it, each as the JSON of a Recorded."""


class BeliefFrame:
    """The belief of one event, in the encodings that somebody asked for."""

    def __init__(
        self,
        mission_id: str,
        emitter_id: str,
        seq: int,
        bearings: int,
        belief: GridBelief,
        corners: list[tuple[float, float]],
    ) -> None:
        self._content = (mission_id, emitter_id, seq, bearings, belief.density, corners)
        self._encoded: dict[bool, bytes] = {}

    def encoded(self, lite: bool) -> bytes:
        """Encoded once, for the first who asks; lite: 8 bits a cell."""
        if lite not in self._encoded:
            self._encoded[lite] = encode_belief(*self._content, lite=lite)
        return self._encoded[lite]


@dataclass(slots=True)
class Slot:
    """version counts the values that were put in; 0: none yet."""

    version: int = 0
    value: str | BeliefFrame | None = None

    def put(self, value: str | BeliefFrame | None) -> None:
        """What was in it is gone: only the newest is sent."""
        self.version += 1
        self.value = value


@dataclass(slots=True)
class Feed:
    """What one mission's viewers see. ring: texts of consecutive events, the newest last."""

    last_seq: int = 0
    ring: deque[str] = field(default_factory=lambda: deque(maxlen=RING))
    slots: dict[SlotName, Slot] = field(default_factory=dict[SlotName, Slot])

    def add(self, record: Recorded) -> bool:
        """False when it was known already. After a gap the ring begins again: viewers read the gap in the journal."""
        if record.seq <= self.last_seq:
            return False
        if self.ring and record.seq != self.last_seq + 1:
            self.ring.clear()
        self.ring.append(event_text(record))
        self.last_seq = record.seq
        return True

    def skip_to(self, seq: int) -> None:
        """The journal is further than what was published here: viewers read that part there."""
        self.ring.clear()
        self.last_seq = seq

    def after(self, seq: int) -> list[str] | None:
        """The texts with a higher number, or None when some are not in the ring any more."""
        missing = self.last_seq - seq
        if missing <= 0:
            return []
        if missing > len(self.ring):
            return None
        return list(islice(self.ring, len(self.ring) - missing, None))


def event_text(record: Recorded) -> str:
    """One text for all viewers."""
    return EventMessage(recorded=record).model_dump_json()


def stored_event_text(told: str) -> str:
    """The same of a Recorded that is JSON already."""
    return f'{{"type":"event","recorded":{told}}}'


@dataclass(eq=False, slots=True)
class Viewer:
    """One websocket. sending_since: loop time at which the send began that has not returned yet, None between sends.

    sent_at: loop time at which a value of each slot was last sent. withheld: slots whose newest value waits for its
    time (a lite viewer's); what is left out on purpose was not missed.
    """

    mission_id: str | None
    lite: bool
    cursor: int
    wake: asyncio.Event = field(default_factory=asyncio.Event)
    seen: dict[SlotName, int] = field(default_factory=dict[SlotName, int])
    dropped: int = 0
    sending_since: float | None = None
    sent_at: dict[SlotName, float] = field(default_factory=dict[SlotName, float])
    withheld: set[SlotName] = field(default_factory=set[SlotName])


class Hub:
    """backend.ports.Publisher; `read` gives stored events after a number. Lives on one event loop."""

    def __init__(self, read: ReadEvents, now: Callable[[], float]) -> None:
        self.read = read
        self._now = now
        self._viewers: set[Viewer] = set()
        self._feeds: OrderedDict[str, Feed] = OrderedDict()
        self._slots: dict[SlotName, Slot] = {STATUS: Slot()}

    # Publisher

    def events(self, recorded: Sequence[Recorded]) -> None:
        """Each event once and in order, whatever is shown twice; a bearing empties the turn's progress."""
        for record in recorded:
            feed = self.feed(record.mission_id)
            if feed.add(record):
                if record.event.kind in {"sweep_started", "sweep_rejected", "bearing_measured"}:
                    for (kind, _), slot in feed.slots.items():
                        if kind == "sweep_progress":
                            slot.put(None)
                self._wake(record.mission_id)

    def telemetry(self, craft_id: str, telemetry: Telemetry, now_s: float) -> None:
        """The newest of each craft takes the place of the one before."""
        slot = self._slots.setdefault(("telemetry", craft_id), Slot())
        slot.put(telemetry_message(craft_id, telemetry, now_s).model_dump_json())
        self._wake(None)

    def sweep_progress(
        self,
        mission_id: str,
        craft_id: str,
        emitter_id: str,
        place_number: int,
        heading_deg: list[float],
        power_db: list[float],
        turned_deg: float,
        sector: SectorShown | None = None,
    ) -> None:
        """Thinned to PROGRESS_POINTS."""
        step = -(-len(heading_deg) // PROGRESS_POINTS) or 1
        message = SweepProgress(
            mission_id=mission_id,
            craft_id=craft_id,
            emitter_id=emitter_id,
            place_number=place_number,
            heading_deg=[round(heading, 1) for heading in heading_deg[::step]],
            power_db=[round(power, 1) for power in power_db[::step]],
            turned_deg=turned_deg,
            sector=None
            if sector is None
            else SectorMessage(begin_deg=sector.begin_deg, goal_deg=sector.goal_deg, because=sector.because),
        )
        self._put(mission_id, ("sweep_progress", f"{craft_id}/{emitter_id}"), message.model_dump_json())

    def _put(self, mission_id: str, name: SlotName, value: str | BeliefFrame) -> None:
        self.feed(mission_id).slots.setdefault(name, Slot()).put(value)
        self._wake(mission_id)

    def belief(
        self,
        mission_id: str,
        emitter_id: str,
        seq: int,
        bearings: int,
        belief: GridBelief,
        corners_lon_lat: list[tuple[float, float]],
    ) -> None:
        """The newest of each emitter takes the place of the one before; encoded when somebody asks."""
        frame = BeliefFrame(mission_id, emitter_id, seq, bearings, belief, corners_lon_lat)
        self._put(mission_id, ("belief", emitter_id), frame)

    def status(self, status: Status) -> None:
        """Shown to every viewer, of whatever mission."""
        message = StatusMessage(
            at_utc=datetime.fromtimestamp(self._now(), UTC),
            mission_id=status.mission_id,
            phase=status.phase,
            crafts=[CraftStatusMessage.model_validate(asdict(craft)) for craft in status.crafts],
            viewers=len(self._viewers),
            database=status.database,
        )
        self._slots[STATUS].put(message.model_dump_json())
        self._wake(None)

    def watchers(self) -> int:
        """Viewers that take what they are sent: one whose send has not returned for some seconds is no watcher."""
        now = asyncio.get_running_loop().time()
        return sum(viewer.sending_since is None or now - viewer.sending_since < STALLED_S for viewer in self._viewers)

    # Viewers

    def feeds(self) -> int:
        """How many missions are kept in memory."""
        return len(self._feeds)

    def viewers(self) -> int:
        """How many websockets are open, those that take nothing just now among them."""
        return len(self._viewers)

    def join(self, viewer: Viewer, last_seq: int) -> None:
        """last_seq: of the mission in the journal. The newest value of each slot counts as unseen, older ones not as
        missed."""
        if viewer.mission_id is not None and last_seq > self.feed(viewer.mission_id).last_seq:
            self.feed(viewer.mission_id).skip_to(last_seq)
            self._wake(viewer.mission_id)
        for name, slot in self.slots(viewer).items():
            viewer.seen[name] = max(0, slot.version - 1)
        self._viewers.add(viewer)

    def leave(self, viewer: Viewer) -> None:
        """Harmless for a viewer that has left already."""
        self._viewers.discard(viewer)

    def slots(self, viewer: Viewer) -> dict[SlotName, Slot]:
        """What this viewer may be sent: everybody's, and those of the mission that it follows."""
        if viewer.mission_id is None:
            return dict(self._slots)
        return self._slots | self.feed(viewer.mission_id).slots

    def feed(self, mission_id: str) -> Feed:
        """Feeds nobody asked for longest are forgotten; the journal has their events."""
        if mission_id not in self._feeds:
            self._feeds[mission_id] = Feed()
            watched = {viewer.mission_id for viewer in self._viewers}
            for other in [name for name in self._feeds if name not in watched and name != mission_id]:
                if len(self._feeds) <= FEEDS:
                    break
                del self._feeds[other]
        self._feeds.move_to_end(mission_id)
        return self._feeds[mission_id]

    def _wake(self, mission_id: str | None) -> None:
        for viewer in self._viewers:
            if mission_id is None or viewer.mission_id == mission_id:
                viewer.wake.set()
