"""Why something is so, or cannot be: a frozen dataclass with a code and its values in SI units.

Logic looks at the class or at the values, never at words. The English sentence stands beside the class; other languages
have a table keyed by `code`. How a value is shown follows from the end of its name: `_m`, `_m2`, `_m_s`, `_s`, `_deg`,
`_percent`, `_hz`, `_db`, `_bytes`, and `_time_s`, which the page writes as minutes and seconds everywhere.

A sentence is complete: it begins with a capital and ends with its mark, so that nobody mends it where it is shown.
It may hold

    {age_s}                              the value with its unit, rounded as usual for its kind
    {quality:2}                          with two decimals
    {lat_deg@lon_deg}                    a place on the earth, from two values
    {bearings|bearing|bearings}          a number with the word in singular or plural
    {link?vehicle=radio|receiver=SDR}    one of several words; `*` stands for any other value, `none` for no value;
                                         of a list one for each
    {because}                            another reason's sentence; several stand one after the other
    {because!remedy}                     another reason's remedy
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, cast


@dataclass(frozen=True, slots=True)
class Words:
    """text: what is so. remedy: how to mend it, empty when there is nothing to do."""

    text: str
    remedy: str = ""


class Reason(Protocol):
    """code: unique among all reasons; a field with a `Literal` type and that value as its default."""

    english: ClassVar[Words]

    @property
    def code(self) -> str:
        """The name by which a language finds its words."""
        ...


class ReasonedError(Exception):
    """An error that says why: `reason` travels on, `str()` is English for a log or a terminal."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(reason)
        self._reason = reason

    @property
    def reason(self) -> Reason:
        """Read-only, so that a subclass may narrow it to the reasons it takes."""
        return self._reason

    def __str__(self) -> str:
        return text_of(self.reason)


PLACEHOLDER = re.compile(
    r"\{(?P<name>\w+)(?:(?P<remedy>!remedy)|@(?P<lon>\w+)|:(?P<decimals>\d)"
    r"|\|(?P<one>[^|{}]*)\|(?P<many>[^|{}]*)|\?(?P<choice>[^{}]*))?\}"
)


def text_of(reason: Reason) -> str:
    """What is so, in English."""
    return _fill(reason.english.text, reason).rstrip()


def remedy_of(reason: Reason) -> str:
    """How to mend it, in English; empty when there is nothing to do."""
    return _fill(reason.english.remedy, reason)


def sentence_of(reason: Reason) -> str:
    """Both, for a log or a terminal."""
    return f"{text_of(reason)} {remedy_of(reason)}".rstrip()


def _fill(template: str, reason: Reason) -> str:
    def put(found: re.Match[str]) -> str:
        value = getattr(reason, found["name"])
        if found["remedy"] is not None:
            return " ".join(remedy_of(one) for one in _several(value))
        if found["lon"] is not None:
            return _place(value, getattr(reason, found["lon"]))
        if found["one"] is not None:
            return f"{value} {found['one'] if value == 1 else found['many']}"
        if found["choice"] is not None:
            return _chosen(found["choice"], value)
        decimals = None if found["decimals"] is None else int(found["decimals"])
        return _shown(found["name"], value, decimals)

    return PLACEHOLDER.sub(put, template)


def _several(value: object) -> Sequence[Reason]:
    return cast(Sequence[Reason], value if isinstance(value, list | tuple) else (value,))


def _chosen(choice: str, value: object) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(_chosen(choice, item) for item in cast(Sequence[object], value))
    words = dict(option.split("=", 1) for option in choice.split("|"))
    key = str(value).lower() if value is None or isinstance(value, bool) else str(value)
    return words[key] if key in words else words["*"]


def _shown(name: str, value: object, decimals: int | None) -> str:
    if isinstance(value, list | tuple):
        items = cast(Sequence[object], value)
        between = " " if items and hasattr(items[0], "english") else ", "
        return between.join(_shown(name, item, decimals) for item in items)
    if hasattr(value, "english"):
        return text_of(cast(Reason, value))
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    for suffix, form in FORMS:
        if name.endswith(suffix):
            return form(value, decimals)
    return _number(value, decimals)


def _number(value: float, decimals: int | None) -> str:
    if decimals is not None:
        return f"{value:.{decimals}f}"
    return f"{value:.0f}" if value == round(value) else f"{value:g}"


def _place(lat_deg: float, lon_deg: float) -> str:
    return f"{abs(lat_deg):.5f} {'S' if lat_deg < 0 else 'N'} {abs(lon_deg):.5f} {'W' if lon_deg < 0 else 'E'}"


def _unit(unit: str, usual: int, scale: float = 1.0) -> Callable[[float, int | None], str]:
    return lambda value, decimals: f"{value / scale:.{usual if decimals is None else decimals}f} {unit}"


def _length(value: float, decimals: int | None) -> str:
    return f"{value / 1e3:.1f} km" if abs(value) >= 1e3 else _unit("m", 0)(value, decimals)


def _area(value: float, decimals: int | None) -> str:
    return f"{value / 1e6:.2f} km²" if abs(value) >= 1e5 else _unit("m²", 0)(value, decimals)


def _frequency(value: float, decimals: int | None) -> str:
    return _unit("MHz", 4, 1e6)(value, decimals) if abs(value) >= 1e6 else _unit("kHz", 1, 1e3)(value, decimals)


def _size(value: float, decimals: int | None) -> str:
    return _unit("MB", 0, 2**20)(value, decimals) if abs(value) >= 2**20 else _unit("kB", 0, 2**10)(value, decimals)


def _time(value: float, decimals: int | None) -> str:
    return f"{value / 60:.0f} min" if abs(value) >= 300 and decimals is None else _unit("s", 0)(value, decimals)


def _clock(value: float, _decimals: int | None) -> str:
    minutes, seconds = divmod(round(value), 60)
    hours, rest = divmod(minutes, 60)
    return f"{hours}:{rest:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"


FORMS: tuple[tuple[str, Callable[[float, int | None], str]], ...] = (
    ("_deg_s", _unit("degrees/s", 0)),
    ("_m_s", _unit("m/s", 1)),
    ("_m2", _area),
    ("_m", _length),
    ("_time_s", _clock),
    ("_s", _time),
    ("_deg", _unit("degrees", 0)),
    ("_percent", _unit("%", 0)),
    ("_hz", _frequency),
    ("_db", _unit("dB", 1)),
    ("_bytes", _size),
)
"""How a value is written, by the end of its name; the first that fits."""
