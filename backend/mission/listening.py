"""The receiver while a mission runs: opened, drained without pause, and known to be well, silent or gone."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections import deque
from typing import Literal

from backend.spec import EmitterSpec
from hardware.autopilot.patience import Deadline
from hardware.ports import Clock, HardwareError, HearsPulses, Receiver, ReceiverError
from hardware.readings import PowerSample, Pulses

log = logging.getLogger("crossfix.mission")

KEPT_SAMPLES = 60_000
REOPEN_S = 1.0
MISSED_PULSES = 10
LATE_WALL_S = 2.0
CATCH_UP_S = 0.005
"""A receiver that catches up keeps everybody else waiting no longer; a sample a turn of the loop never catches up."""


class Listening:
    """Keeps the last samples. A receiver that fails is opened again every second until it answers."""

    def __init__(
        self,
        receiver: Receiver,
        clock: Clock,
        frequency_hz: float,
        silent_after_s: float,
        pulses: Pulses | None = None,
    ) -> None:
        self._receiver = receiver
        self._clock = clock
        self._frequency_hz = frequency_hz
        # a tag that is far away may stay unheard for some of its pulses
        patience_s = 0.0 if pulses is None else MISSED_PULSES * pulses.period_s
        self._silent_after_s = max(silent_after_s, patience_s)
        self._pulses = pulses
        self._samples: deque[PowerSample] = deque(maxlen=KEPT_SAMPLES)
        self._heard_at_s: float | None = None
        self._quiet_s = 0.0
        self._heard = asyncio.Event()
        self._fault: str | None = None
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        self._task = asyncio.create_task(self._listen())

    async def stop(self) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
            self._task = None
        await self._receiver.close()

    async def _listen(self) -> None:
        while True:
            try:
                self._expect()
                await self._receiver.open(self._frequency_hz)
                others_due = time.monotonic()
                async for sample in self._receiver.samples():
                    self._samples.append(sample)
                    self._heard_at_s = self._clock.now()
                    self._quiet_s = 0.0
                    if sample.detected:
                        self._heard.set()
                    self._fault = None
                    if time.monotonic() > others_due:
                        await asyncio.sleep(0)
                        others_due = time.monotonic() + CATCH_UP_S
                self._fault = "the receiver was closed"
            except HardwareError as error:
                if self._fault is None:
                    log.warning("receiver: %s", error)
                self._fault = str(error)
            await self._clock.sleep(REOPEN_S)

    def _expect(self) -> None:
        """Raises ReceiverError when pulses are wanted of a receiver that cannot find them."""
        if isinstance(self._receiver, HearsPulses):
            self._receiver.expect(self._pulses)
        elif self._pulses is not None:
            raise ReceiverError("this receiver measures carriers only; a pulsed tag needs one that delivers IQ")

    @property
    def state(self) -> Literal["ok", "silent", "off", "lost"]:
        if self._task is None:
            return "off"
        if self._fault is not None:
            return "lost"
        return "silent" if self._quiet_s > self._silent_after_s else "ok"

    def wait(self, seconds: float) -> None:
        """So much time went by in which a sample would have been noticed; silence is counted in it."""
        self._quiet_s += seconds

    @property
    def trouble(self) -> str:
        """What is wrong, in the operator's words; empty when all is well."""
        match self.state:
            case "lost":
                return self._fault or "the receiver is gone"
            case "silent":
                return f"silent for {self._quiet_s:.0f} s"
            case _:
                return ""

    @property
    def last(self) -> PowerSample | None:
        return self._samples[-1] if self._samples else None

    @property
    def age_s(self) -> float | None:
        return None if self._heard_at_s is None else self._clock.now() - self._heard_at_s

    def between(self, begin_s: float, end_s: float) -> list[PowerSample]:
        """Samples taken in [begin_s, end_s], oldest first; pulses that were not heard among them."""
        found = []
        for sample in reversed(self._samples):
            if sample.at_s < begin_s:
                break
            if sample.at_s <= end_s:
                found.append(sample)
        return found[::-1]

    async def heard_until(self, at_s: float) -> None:
        """Wait for the samples of the time before `at_s`: a link or a busy machine brings them late.

        Not when nothing new came for as long as the receiver may be silent.
        """
        newest_s = -math.inf
        patience = Deadline(self._clock, self._silent_after_s, LATE_WALL_S)
        while newest_s < at_s and not patience.passed:
            if self.last is not None and self.last.at_s > newest_s:
                newest_s = self.last.at_s
                patience = Deadline(self._clock, self._silent_after_s, LATE_WALL_S)
            else:
                await asyncio.sleep(0.02)

    async def first_sample(self, wall_s: float) -> bool:
        """Whether a carrier's sample or a tag's pulse is heard within so many seconds of the wall."""
        try:
            async with asyncio.timeout(wall_s):
                await self._heard.wait()
        except TimeoutError:
            return False
        return True


def expected_pulses(emitter: EmitterSpec) -> Pulses | None:
    """What the receiver is told to listen for; None for a carrier."""
    if emitter.kind == "carrier":
        return None
    return Pulses(emitter.pulse_width_s, emitter.pulse_period_s, emitter.pulse_jitter_s)
