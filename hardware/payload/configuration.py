"""The payload's configuration: one TOML file that survives reboots; the command line's options override it."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, JsonValue, ValidationError, field_validator

from hardware.payload.session import SHORTEST_TOKEN
from hardware.readings import Channel, Pulses
from hardware.reasons.channels import ImpossiblePulses
from hardware.reasons.payload_link import (
    ConfigurationEntryMissing,
    ConfigurationEntryWrong,
    ConfigurationUnreadable,
    PulseTimingIncomplete,
)
from planner.reason import ReasonedError


class ConfigurationError(ReasonedError):
    """The configuration cannot be used."""

    def __init__(
        self,
        reason: ConfigurationUnreadable
        | ConfigurationEntryMissing
        | ConfigurationEntryWrong
        | PulseTimingIncomplete
        | ImpossiblePulses,
    ) -> None:
        super().__init__(reason)


class PayloadConfiguration(BaseModel):
    """servers: websocket URLs, tried in turn. pulse_*: set both for a pulsed tag, none for a carrier."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    servers: tuple[str, ...] = Field(min_length=1)
    token: str = Field(min_length=SHORTEST_TOKEN, max_length=200)
    receiver: str = Field(min_length=1)
    frequency_hz: float = Field(gt=0, le=1e12)
    name: str = Field(default="payload", min_length=1, max_length=80, pattern=r"^[\w.\-]+$")
    data_dir: Path = Path("payload-data")
    sample_rate_hz: float = Field(default=250_000.0, gt=0)
    gain_db: float = Field(default=28.0, ge=-20, le=100)
    pulse_width_s: float | None = Field(default=None, gt=0)
    pulse_period_s: float | None = Field(default=None, gt=0)

    @property
    def channel(self) -> Channel:
        """What to listen to until the server asks for something else."""
        if self.pulse_width_s is None or self.pulse_period_s is None:
            return Channel(self.frequency_hz)
        return Channel(self.frequency_hz, Pulses(self.pulse_width_s, self.pulse_period_s))

    @field_validator("servers")
    @classmethod
    def websocket_addresses(cls, servers: tuple[str, ...]) -> tuple[str, ...]:
        """A server without a path gets /api/payload. Raises ValueError for what is no websocket address."""
        for server in servers:
            parts = urlsplit(server)
            if parts.scheme not in {"ws", "wss"} or not parts.hostname:
                raise ValueError(f'"{server}" is no websocket address; write ws://HOST:PORT or wss://HOST')
        return tuple(s if urlsplit(s).path not in {"", "/"} else s.rstrip("/") + "/api/payload" for s in servers)


def load_configuration(path: Path | None, overrides: dict[str, object]) -> PayloadConfiguration:
    """The file's entries (if there is one) with `overrides` (None: not given) on top. Raises ConfigurationError."""
    entries: dict[str, object] = {}
    if path is not None and path.exists():
        try:
            entries = tomllib.loads(path.read_text(encoding="utf-8"))
        except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ConfigurationError(ConfigurationUnreadable(str(path), str(error))) from error
    entries |= {key: value for key, value in overrides.items() if value is not None}
    try:
        configuration = PayloadConfiguration.model_validate(entries)
    except ValidationError as error:
        first = error.errors()[0]
        entry = ".".join(str(part) for part in first["loc"])
        if first["type"] == "missing":
            option = {"servers": "server"}.get(entry, entry).replace("_", "-")
            raise ConfigurationError(ConfigurationEntryMissing(entry, option)) from error
        raise ConfigurationError(ConfigurationEntryWrong(entry, first["msg"].removeprefix("Value error, "))) from error
    width_s, period_s = configuration.pulse_width_s, configuration.pulse_period_s
    if (width_s is None) != (period_s is None):
        raise ConfigurationError(PulseTimingIncomplete())
    if width_s is not None and period_s is not None and width_s >= period_s:
        raise ConfigurationError(ImpossiblePulses(width_s, period_s))
    return configuration


def save_configuration(configuration: PayloadConfiguration, path: Path) -> None:
    """Write the file, readable by its owner only (it holds the token), whole or not at all."""
    lines: list[str] = []
    for key, value in configuration.model_dump(mode="json").items():
        if value is None:
            continue
        lines.append(f"{key} = {_toml(value)}")
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".new")
    descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(path)


def _toml(value: JsonValue) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    return repr(value)
