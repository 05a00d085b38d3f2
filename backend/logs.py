"""What the program says of itself: one line a record, in words for a terminal or as JSON for a machine.

Every line carries the mission, the craft and the command that it is about, whoever wrote it: `about` sets them for what
runs inside it and for the tasks that begin there.
"""

from __future__ import annotations

import logging
import sys
from collections.abc import Generator
from contextlib import contextmanager
from contextvars import ContextVar
from logging.handlers import RotatingFileHandler
from typing import Literal

from pythonjsonlogger.json import JsonFormatter

from backend.settings import Settings

NAMES = ("mission", "craft", "command")
TEXT = "%(asctime)s %(levelname)s %(name)s: %(message)s%(about)s"
JSON_FIELDS = ("levelname", "name", "message", *NAMES)

_about: ContextVar[tuple[str | None, str | None, str | None]] = ContextVar("about", default=(None, None, None))


@contextmanager
def about(
    mission: str | Literal[""] | None = "", craft: str | Literal[""] | None = "", command: str | Literal[""] | None = ""
) -> Generator[None]:
    """The ids of what is worked on. "": as it is outside; None: no such thing from here on."""
    given = (mission, craft, command)
    now = tuple(known if new == "" else new for known, new in zip(_about.get(), given, strict=True))
    token = _about.set((now[0], now[1], now[2]))
    try:
        yield
    finally:
        _about.reset(token)


class _Named(logging.Filter):
    """Puts the ids on every record that passes a handler."""

    def filter(self, record: logging.LogRecord) -> bool:
        ids = dict(zip(NAMES, _about.get(), strict=True))
        for name, value in ids.items():
            setattr(record, name, value)
        known = " ".join(f"{name}={value}" for name, value in ids.items() if value is not None)
        record.about = f" [{known}]" if known else ""
        return True


def _handler(made: logging.Handler, form: Literal["text", "json"], level: int) -> logging.Handler:
    machine = JsonFormatter(
        JSON_FIELDS,
        rename_fields={"levelname": "level", "name": "logger"},
        timestamp="at_utc",
        reserved_attrs=[*logging.makeLogRecord({}).__dict__, "about", "taskName"],
    )
    made.setFormatter(machine if form == "json" else logging.Formatter(TEXT))
    made.addFilter(_Named())
    made.setLevel(level)
    return made


def configure(settings: Settings, verbose: bool = False) -> None:
    """Of this process, in place of what was set up before. Raises OSError when the file cannot be written."""
    level = logging.INFO if verbose else getattr(logging, settings.log_level.upper())
    handlers = [_handler(logging.StreamHandler(sys.stderr), settings.log_format, level)]
    if settings.log_file is not None:
        settings.log_file.parent.mkdir(parents=True, exist_ok=True)
        file = RotatingFileHandler(
            settings.log_file, maxBytes=settings.log_file_bytes, backupCount=settings.log_files_kept, encoding="utf-8"
        )
        handlers.append(_handler(file, "json", logging.INFO))
    logging.getLogger("aiosqlite").setLevel(logging.INFO)  # below it tells all values, digests of passwords too
    logging.basicConfig(level=min(handler.level for handler in handlers), handlers=handlers, force=True)
