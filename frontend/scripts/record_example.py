"""Record the flight that the page shows as its example: what the websocket says during one simulated mission.

    python frontend/scripts/record_example.py        (or: make example)

The file: {"said": [[seconds since the start of the flight, message], ...]}. A message is the websocket's own; a text is
a binary frame in base64. It is thinned, because the whole page must stay light: values as a thin link gets them
(`lite`: once a second, beliefs in 8 bits), numbers rounded to what a screen shows, of each belief what the map draws.
Ids are shortened and the wait before the start is cut; nothing else is changed.

Record it again whenever the wire changes.
"""

from __future__ import annotations

import asyncio
import base64
import json
import re
import struct
import tempfile
import time
import zlib
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import websockets

from backend.cli.demo import fly
from backend.cli.running import RunningServer, running_server
from backend.settings import Settings, settings_of
from backend.wire.belief_frame import DECADES, encode_belief

RECORDING = Path(__file__).resolve().parents[1] / "public" / "example.json"
MISSION_ID = "example"
SEED = 3
TIME_FACTOR = 6.0
WANTED: dict[str, dict[str, Any]] = {
    "localization": {"expected_rmse_m": 50.0},
    "planner": {"action_spacing_m": 45.0},
}
"""Localized after few bearings, each place chosen from few: the recording is short."""
AFTERWARDS_S = 2.0
PATIENCE = 600
"""Looks for the draft, ten a second."""

DECIMALS = 1
DECIMALS_OF = {
    "lat": 6, "lon": 6, "coordinates": 6, "quality": 2, "outlier_probability": 3, "pulse_width_s": 3,
    "position_age_s": 0, "heading_age_s": 0, "battery_age_s": 0, "mode_age_s": 0, "receiver_age_s": 0,
    "binned_db": 0, "fitted_db": 0, "power_db": 0, "heading_deg": 0, "value_s": 1, "std_error_s": 1,
}  # fmt: skip
"""Of degrees: 0.1 m."""
PROGRESS_POINTS = 24
STATUS_S = 6.0
CELLS = 6400
DRAWN = 1e-3
"""Of the peak: what is less the map does not show."""
LEVELS = 4
"""Steps of the 8-bit logarithm that differ: a quarter of a probability."""

Said = list[tuple[float, dict[str, Any] | str]]


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        settings = settings_of(
            host="127.0.0.1",
            port=0,
            data_dir=Path(folder),
            simulate="px4",
            simulated_flies_on=False,
            time_factor=TIME_FACTOR,
            seed=SEED,
        )
        mission_id, said = asyncio.run(record(settings))
    text = json.dumps({"said": thinned(from_start(said))}, separators=(",", ":"))
    RECORDING.write_text(short_ids(text.replace(mission_id, MISSION_ID)) + "\n")
    size = RECORDING.stat().st_size
    print(f"{RECORDING.name}: {len(said)} messages in {said[-1][0]:.0f} s, {size} bytes, {compressed(text)} compressed")


def compressed(text: str) -> int:
    return len(zlib.compress(text.encode(), 9))


async def record(settings: Settings) -> tuple[str, Said]:
    async with running_server(settings) as running:
        flying = asyncio.create_task(fly(running, settings, mend=True, changes=WANTED))
        mission_id = await drafted(running)
        listening = asyncio.create_task(listen(running, mission_id))
        await flying
        await asyncio.sleep(AFTERWARDS_S)
        listening.cancel()
        return mission_id, await listening


async def drafted(running: RunningServer) -> str:
    async with httpx.AsyncClient(base_url=running.url) as client:
        for _ in range(PATIENCE):
            missions = (await client.get("/api/missions")).json()["missions"]
            if missions:
                return missions[0]["mission_id"]
            await asyncio.sleep(0.1)
    raise TimeoutError("no mission was drafted")


def from_start(said: Said) -> Said:
    """What was told before the start at second 0; values of that time are left out."""
    started_s = next(at_s for at_s, message in said if kind_of(message) == "mission_started")
    kept = ("hello", "event")
    return [
        (max(0.0, at_s - started_s), message)
        for at_s, message in said
        if at_s >= started_s or isinstance(message, str) or message["type"] in kept
    ]


def kind_of(message: dict[str, Any] | str) -> str | None:
    told = isinstance(message, dict) and message["type"] == "event"
    return message["recorded"]["event"]["kind"] if told else None


async def listen(running: RunningServer, mission_id: str) -> Said:
    """Until cancelled. The first frame is the prior, which no event tells of."""
    async with httpx.AsyncClient(base_url=running.url) as client:
        prior = await client.get(f"/api/missions/{mission_id}/beliefs", params={"seq": 1, "lite": True})
    said: Said = [(0.0, thinned_frame(prior.content))]
    began = time.monotonic()
    address = running.url.replace("http", "ws", 1) + f"/api/live?mission={mission_id}&after=0&lite=1"
    async with websockets.connect(address, max_size=None) as socket:
        try:
            async for message in socket:
                heard = thinned_frame(message) if isinstance(message, bytes) else json.loads(message)
                said.append((time.monotonic() - began, heard))
        except asyncio.CancelledError:
            pass
    return said


def thinned(said: Said) -> Said:
    kept: Said = []
    status_at_s = -STATUS_S
    for at_s, message in said:
        if isinstance(message, dict):
            if message["type"] == "status":
                if at_s < status_at_s + STATUS_S:
                    continue
                status_at_s = at_s
            if message["type"] == "sweep_progress":
                step = -(-len(message["heading_deg"]) // PROGRESS_POINTS)
                message |= {key: message[key][::step] for key in ("heading_deg", "power_db")}
        kept.append((round(at_s, 1), rounded(message)))
    return kept


def rounded(value: Any, decimals: int = DECIMALS) -> Any:
    match value:
        case float():
            near = round(value, decimals)
            return int(near) if near == int(near) else near
        case list():
            return [rounded(item, decimals) for item in value]
        case dict():
            return {key: rounded(item, DECIMALS_OF.get(key, decimals)) for key, item in value.items()}
        case _:
            return value


def short_ids(text: str) -> str:
    """Ids by their order, digests by their beginning, times to the tenth of a second."""
    found = list(dict.fromkeys(re.findall(r"[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}", text)))
    for number, long in enumerate(found, start=1):
        text = text.replace(long, f"id-{number}")
    text = re.sub(r'("digest":"\w{8})\w+', r"\1", text)
    return re.sub(r"(:\d\d\.\d)\d+Z", r"\1Z", text)


def thinned_frame(frame: bytes) -> str:
    """A lite frame with cells as large as needed to keep few, and none that the map does not show; base64."""
    (length,) = struct.unpack("<I", frame[:4])
    header = json.loads(frame[4 : 4 + length])
    level = np.frombuffer(zlib.decompress(frame[4 + length :]), np.uint8).reshape(header["ny"], header["nx"])
    density = np.where(level == 0, 0.0, header["peak"] * 10.0 ** (DECADES * (level / 255.0 - 1.0)))
    while density.size > CELLS and not any(n % 2 for n in density.shape):
        rows, columns = (n // 2 for n in density.shape)
        density = density.reshape(rows, 2, columns, 2).sum(axis=(1, 3))
    peak = density.max()
    shown = density >= DRAWN * peak
    step = LEVELS * DECADES / 255.0
    density = np.where(
        shown, peak * 10.0 ** (step * np.rint(np.log10(np.where(shown, density / peak, 1.0)) / step)), 0.0
    )
    corners = [(round(lon, 7), round(lat, 7)) for lon, lat in header["bounds"]]
    again = encode_belief(
        MISSION_ID, header["emitter_id"], header["seq"], header["bearings"], density, corners, lite=True
    )
    return base64.b64encode(again).decode()


if __name__ == "__main__":
    main()
