"""Start, find and order a simulated autopilot from asyncio."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import socket
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hardware.ports import HardwareError
from hardware.reasons.simulation import SimulatorRefused, SimulatorSilent
from hardware.sim.autopilot.geodesy import HomeFrame

LINGER_S = 1800.0


class SimulatorError(HardwareError):
    """The simulated autopilot did not start or did not answer."""


@dataclass(frozen=True, slots=True)
class Setting:
    """What to simulate. wind: (speed m/s, degrees from, gusts m/s). connect_port, control_port: None = any free one.

    keep_running: the vehicle stays in the air when this process dies (find it again with `find_simulated`); after
    LINGER_S wall seconds without anybody it ends all the same. station_timeout_s, clock_rate: see process.Schedule.
    link_delay_s: of the radio, each way. token: by which `find_simulated` tells it from others.
    """

    flavour: str = "px4"
    home: HomeFrame = field(default_factory=lambda: HomeFrame(47.3977419, 8.5455938, 488.0))
    speedup: float = 1.0
    seed: int = 1
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heading_deg: float = 0.0
    battery_percent: float = 100.0
    parameters: Mapping[str, float] = field(default_factory=dict[str, float])
    heading_error_deg: float = 0.0
    connect_port: int | None = None
    control_port: int | None = None
    keep_running: bool = False
    station_timeout_s: float = 8.0
    link_delay_s: float = 0.0
    clock_rate: float = 1.0
    token: str = ""

    def arguments(self, connect_port: int) -> list[str]:
        """The command line of `python -m hardware.sim.autopilot`."""
        home = self.home
        arguments = [
            "--flavour", self.flavour,
            "--connect", f"127.0.0.1:{connect_port}",
            f"--home={home.lat_deg!r},{home.lon_deg!r},{home.amsl_m!r}",
            "--speedup", repr(self.speedup),
            "--seed", str(self.seed),
            f"--wind={','.join(repr(value) for value in self.wind)}",
            f"--heading={self.heading_deg!r}",
            f"--heading-error={self.heading_error_deg!r}",
            "--battery", repr(self.battery_percent),
            "--control", str(self.control_port or 0),
            "--station-timeout", repr(self.station_timeout_s),
            "--link-delay", repr(self.link_delay_s),
            "--clock-rate", repr(self.clock_rate),
            f"--token={self.token}",
        ]  # fmt: skip
        for name, value in self.parameters.items():
            arguments += ["--param", f"{name}={value!r}"]
        ends = ["--linger", str(LINGER_S)] if self.keep_running else ["--parent", str(os.getpid())]
        return arguments + ends


def free_port() -> int:
    """A UDP port on the loopback that nobody uses at this moment."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class _Answers(asyncio.DatagramProtocol):
    def __init__(self) -> None:
        self.queue: asyncio.Queue[bytes] = asyncio.Queue()

    def datagram_received(self, data: bytes, addr: tuple[str, int]) -> None:
        self.queue.put_nowait(data)


class SimulatedAutopilot:
    """A running simulated autopilot: its address for a ground station, and orders to its pilot (see orders.py)."""

    def __init__(self, connect_port: int, control_port: int, process: subprocess.Popen[bytes] | None) -> None:
        self.url = f"udpin://127.0.0.1:{connect_port}"
        self.connect_port = connect_port
        self.control_port = control_port
        self._process = process

    @property
    def pid(self) -> int | None:
        """None when it was found rather than started."""
        return None if self._process is None else self._process.pid

    async def order(self, do: str, timeout_s: float = 2.0, **arguments: Any) -> dict[str, Any]:
        """Send one order; its answer. Raises SimulatorError when it is refused or unanswered (wall seconds)."""
        loop = asyncio.get_running_loop()
        transport, answers = await loop.create_datagram_endpoint(_Answers, remote_addr=("127.0.0.1", self.control_port))
        try:
            transport.sendto(json.dumps({"do": do, **arguments}).encode())
            async with asyncio.timeout(timeout_s):
                answer = json.loads(await answers.queue.get())
        except TimeoutError:
            raise SimulatorError(SimulatorSilent(do, timeout_s)) from None
        finally:
            transport.close()
        if not answer["ok"]:
            raise SimulatorError(SimulatorRefused(answer["error"]))
        return answer

    async def stop(self) -> None:
        """Idempotent; returns when the process has ended."""
        if self._process is None:
            with contextlib.suppress(SimulatorError):
                await self.order("stop", timeout_s=1.0)
            return
        self._process.terminate()
        await asyncio.to_thread(self._process.wait)


async def launch_simulated(setting: Setting, timeout_s: float = 20.0) -> SimulatedAutopilot:
    """Start one in its own process. Raises SimulatorError with its own words when it does not start."""
    connect_port = setting.connect_port or free_port()
    process = await asyncio.to_thread(
        subprocess.Popen,
        [sys.executable, "-m", "hardware.sim.autopilot", *setting.arguments(connect_port)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=setting.keep_running,
    )
    assert process.stdout is not None
    assert process.stderr is not None
    try:
        async with asyncio.timeout(timeout_s):
            line = await asyncio.to_thread(process.stdout.readline)
    except BaseException as error:
        process.kill()
        await asyncio.to_thread(process.communicate)
        if isinstance(error, TimeoutError):
            raise SimulatorError(SimulatorSilent("start", timeout_s)) from None
        raise
    if not line:
        words = (await asyncio.to_thread(process.communicate))[1].decode(errors="replace").strip()
        raise SimulatorError(SimulatorRefused(words or "it ended at once"))
    process.stdout.close()
    process.stderr.close()
    return SimulatedAutopilot(connect_port, json.loads(line)["control_port"], process)


async def find_simulated(connect_port: int, control_port: int, token: str | None = None) -> SimulatedAutopilot | None:
    """One that is running already (it survived its parent), or None. token: it was started with; None: with any."""
    found = SimulatedAutopilot(connect_port, control_port, None)
    try:
        told = await found.order("ping", timeout_s=0.5)
    except (SimulatorError, OSError):
        return None
    return found if token is None or told.get("token") == token else None
