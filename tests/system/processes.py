"""`crossfix serve` in a process of its own, and a simulated vehicle that outlives it."""

from __future__ import annotations

import asyncio
import json
import signal
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated

SPEEDUP = 4.0
START_PATIENCE_S = 240.0
"""A whole start compiles the planner; on a busy machine that takes minutes."""

MOST_SAID_BYTES = 2**24
"""Of standard error that is kept though nobody reads it: a server that says more would stand still."""


@asynccontextmanager
async def serving(data_dir: Path, *more: str) -> AsyncIterator[tuple[str, asyncio.subprocess.Process]]:
    """The URL it printed, and the process; its standard error is piped."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", "from backend.cli.main import app; app()",
        "serve", "--port", "0", "--data-dir", str(data_dir), "--speedup", str(SPEEDUP), "--seed", "3", "--json", *more,
        stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE, limit=MOST_SAID_BYTES,
    )  # fmt: skip
    assert process.stdout is not None
    try:
        async with asyncio.timeout(START_PATIENCE_S):
            line = await process.stdout.readline()
        yield json.loads(line)["url"], process
    finally:
        if process.returncode is None:
            process.send_signal(signal.SIGKILL)
            await process.communicate()


@asynccontextmanager
async def vehicle_apart() -> AsyncIterator[SimulatedAutopilot]:
    """A simulated vehicle that no server owns: pass its URL with --vehicle. However long a server takes to start, it
    does not land by itself."""
    stays_up = {"NAV_DLL_ACT": 1.0, "RTL_LAND_DELAY": -1.0}
    vehicle = await launch_simulated(Setting(speedup=SPEEDUP, seed=3, keep_running=True, parameters=stays_up))
    try:
        yield vehicle
    finally:
        await vehicle.stop()


async def truth_until(
    vehicle: SimulatedAutopilot, seen: Callable[[dict[str, Any]], bool], wall_s: float = 30.0
) -> dict[str, Any]:
    """What the vehicle truly does, once it does that."""
    truth: dict[str, Any] = {}
    try:
        async with asyncio.timeout(wall_s):
            while not seen(truth := await vehicle.order("truth")):  # noqa: ASYNC110 (another process)
                await asyncio.sleep(0.05)
    except TimeoutError:
        raise AssertionError(f"the vehicle did not; it is so: {truth}") from None
    return truth
