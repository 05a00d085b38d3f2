"""The command line's edge: one JSON value on stdout, everything else on stderr, bad input ends with one clear line."""

from __future__ import annotations

import json
from typing import Any, NoReturn

import typer

from planner.reason import ReasonedError, sentence_of

BAD_INPUT = 2


def stop(message: object) -> NoReturn:
    """One line on stderr, exit code 2."""
    typer.echo(f"crossfix: {words_of(message)}", err=True)
    raise typer.Exit(BAD_INPUT)


def words_of(message: object) -> str:
    """On one line; of an error with a reason, the remedy too."""
    words = sentence_of(message.reason) if isinstance(message, ReasonedError) else str(message)
    return " ".join(words.split())


def remark(*messages: str) -> None:
    """What the user should know that is not the answer."""
    for message in messages:
        typer.echo(f"note: {message}", err=True)


def print_json(value: Any) -> None:
    """Exactly one JSON value on stdout; numbers that are not finite are a defect and raise."""
    typer.echo(json.dumps(value, allow_nan=False))


def parse_place(text: str) -> tuple[float, float]:
    """ "LAT,LON" in degrees. Raises ValueError with a sentence."""
    parts = text.split(",")
    try:
        lat, lon = float(parts[0]), float(parts[1])
    except (ValueError, IndexError):
        raise ValueError(f'"{text}" is no place: write LAT,LON in degrees, for instance 50.61,7.20') from None
    if len(parts) != 2 or not (-90.0 <= lat <= 90.0 and -180.0 <= lon <= 180.0):
        raise ValueError(f'"{text}" is no place: latitude -90..90, longitude -180..180')
    return lat, lon
