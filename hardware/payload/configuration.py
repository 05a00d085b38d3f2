"""The payload's configuration: one TOML file that survives reboots; the command line's options override it."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from hardware.payload.session import SHORTEST_TOKEN


class ConfigurationError(ValueError):
    """Names the file and the entry, and says how to mend it."""


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

    @field_validator("servers")
    @classmethod
    def websocket_addresses(cls, servers: tuple[str, ...]) -> tuple[str, ...]:
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
            raise ConfigurationError(f"{path}: is no readable TOML file ({error})") from error
    entries |= {key: value for key, value in overrides.items() if value is not None}
    try:
        return PayloadConfiguration.model_validate(entries)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        where = f"{path}: " if path is not None else ""
        missing = first["type"] == "missing"
        option = {"servers": "server"}.get(place, place).replace("_", "-")
        what = f"is missing; give --{option} or write it into the file" if missing else first["msg"]
        raise ConfigurationError(f'{where}"{place}" {what}') from error


def save_configuration(configuration: PayloadConfiguration, path: Path) -> None:
    """Write the file, readable by its owner only (it holds the token), whole or not at all."""
    lines = []
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


def _toml(value: object) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    return repr(value)
