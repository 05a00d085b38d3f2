"""The simulator as a process: started, ordered, stopped, orphaned."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
import textwrap

import psutil
import pytest

from hardware.sim.autopilot.__main__ import main
from hardware.sim.autopilot.launch import Setting, SimulatorError, find_simulated, free_port, launch_simulated

PARENT = textwrap.dedent(
    """
    import asyncio, json, sys
    from hardware.sim.autopilot.launch import Setting, launch_simulated

    async def go():
        sim = await launch_simulated(Setting(keep_running=sys.argv[1] == "keep"))
        print(json.dumps([sim.pid, sim.connect_port, sim.control_port]), flush=True)
        await asyncio.sleep(60)

    asyncio.run(go())
    """
)


def gone(pid: int) -> bool:
    return not psutil.pid_exists(pid) or psutil.Process(pid).status() == psutil.STATUS_ZOMBIE


async def until_gone(pid: int) -> bool:
    for _ in range(100):
        if gone(pid):
            return True
        await asyncio.sleep(0.05)
    return False


async def test_it_starts_answers_and_stops() -> None:
    sim = await launch_simulated(Setting(flavour="ardupilot", speedup=5.0, parameters={"FS_GCS_ENABLE": 0}))
    try:
        assert (await sim.order("ping"))["flavour"] == "ardupilot"
        first = (await sim.order("ping"))["time_s"]
        await asyncio.sleep(0.2)
        assert (await sim.order("ping"))["time_s"] > first + 0.5
        with pytest.raises(SimulatorError, match="no order"):
            await sim.order("dance")
    finally:
        await sim.stop()
        await sim.stop()
    assert sim.pid is not None
    assert gone(sim.pid)
    assert await find_simulated(sim.connect_port, sim.control_port) is None


@pytest.mark.parametrize("keep", [False, True])
async def test_when_its_parent_is_killed_it_ends_unless_it_was_asked_to_fly_on(keep: bool) -> None:
    command = [sys.executable, "-c", PARENT, "keep" if keep else "end"]
    parent = await asyncio.to_thread(subprocess.Popen, command, stdout=subprocess.PIPE)
    assert parent.stdout is not None
    pid, connect, control = json.loads(await asyncio.to_thread(parent.stdout.readline))

    os.kill(parent.pid, signal.SIGKILL)
    parent.wait()
    parent.stdout.close()

    if not keep:
        assert await until_gone(pid)
        return
    await asyncio.sleep(0.6)
    found = await find_simulated(connect, control)
    assert found is not None
    assert found.url == f"udpin://127.0.0.1:{connect}"
    await found.stop()
    assert await until_gone(pid)


async def test_left_alone_by_everybody_it_ends_after_a_while() -> None:
    command = [sys.executable, "-m", "hardware.sim.autopilot", "--linger", "0.6"]
    alone = await asyncio.to_thread(subprocess.Popen, command, stdout=subprocess.PIPE)
    assert alone.stdout is not None
    control = json.loads(await asyncio.to_thread(alone.stdout.readline))["control_port"]
    for _ in range(4):
        await asyncio.sleep(0.3)
        assert await find_simulated(1, control) is not None  # asked, it stays

    assert await asyncio.to_thread(alone.wait, 10) == 0
    alone.stdout.close()


async def test_what_it_cannot_do_it_says_in_its_own_words() -> None:
    with pytest.raises(SimulatorError, match="no parameter NO_SUCH"):
        await launch_simulated(Setting(parameters={"NO_SUCH": 1.0}))
    with pytest.raises(SimulatorError, match="invalid choice: 'paparazzi'"):
        await launch_simulated(Setting(flavour="paparazzi"))


async def test_a_second_one_on_the_same_order_port_is_refused() -> None:
    port = free_port()
    first = await launch_simulated(Setting(control_port=port))
    try:
        with pytest.raises(SimulatorError, match="cannot start"):
            await launch_simulated(Setting(control_port=port))
    finally:
        await first.stop()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--home", "47,8"], "LAT,LON,AMSL"),
        (["--home", "95,8,0"], "no usable place"),
        (["--connect", "14540"], "HOST:PORT"),
        (["--speedup", "0"], "not above zero"),
        (["--wind", "5"], "SPEED,FROM"),
        (["--param", "NAV_DLL_ACT"], "NAME=VALUE"),
        (["--wind", "nan,0"], "SPEED,FROM"),
    ],
)
def test_wrong_arguments_are_explained(arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(arguments)

    assert ended.value.code == 2
    assert says in capsys.readouterr().err
