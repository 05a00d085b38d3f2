"""Examples of a room's reasons, built from their fields, and what every reason's words must keep to."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, fields, is_dataclass
from itertools import pairwise
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from backend.reasons.catalogue import reason_classes
from planner.reason import Reason, remedy_of, text_of

PLAIN: dict[type, tuple[object, ...]] = {
    str: ("Example",),
    int: (1, 3),
    float: (12.5,),
    bool: (True, False),
    NoneType: (None,),
}
"""Values to try for a field: one and several for a number with a word in singular and plural."""


def classes_of(union: Any) -> tuple[type[Reason], ...]:
    """The classes of a room's union (`HardwareReason`, ...), in its order; of a single class, itself."""
    return tuple(get_args(union)) if get_origin(union) in (Union, UnionType) else (union,)


def example(reason: type[Reason]) -> Reason:
    """One instance, every field with the first of its values."""
    return examples(reason)[0]


def examples(reason: type[Reason]) -> list[Reason]:
    """Instances that show every value of every `Literal`, None, both booleans, singular and plural, each once."""
    return _instances(reason, ())


def assert_well_said(reason: Reason) -> None:
    """Whole sentences, nothing left unfilled, and values that come back from JSON."""
    code = next(field for field in fields(reason) if field.name == "code")  # type: ignore[arg-type]
    assert code is fields(reason)[-1], f"{reason!r}: code is its last field"  # type: ignore[arg-type]
    assert get_args(get_type_hints(type(reason))["code"]) == (reason.code,), f"{reason!r}: Literal and default differ"
    assert "__dict__" not in dir(reason), f"{reason!r}: has slots"
    json.dumps(asdict(reason), allow_nan=False)  # type: ignore[call-overload]
    text, remedy = text_of(reason), remedy_of(reason)
    assert text, f"{reason!r}: says nothing"
    for said in filter(None, (text, remedy)):
        whole = not said[0].islower() and said[-1] in ".!?"
        assert whole, f"{reason!r}: no whole sentence: {said}"
        assert said == " ".join(said.split()), f"{reason!r}: blanks: {said}"
        assert not {"None", "True", "False", "{", "}"} & _parts(said), f"{reason!r}: unfilled: {said}"


def assert_codes_differ(unions: Iterable[Any]) -> None:
    """No code stands for two classes, whatever the room."""
    codes = sorted(example(reason).code for union in unions for reason in classes_of(union))
    twice = {code for code, following in pairwise(codes) if code == following}
    assert not twice, f"used by two reasons: {', '.join(sorted(twice))}"


def _parts(said: str) -> set[str]:
    return set(said.replace(".", " ").replace(",", " ").split()) | set(said)


def _instances(reason: type[Reason], inside: tuple[type, ...]) -> list[Reason]:
    """inside: the reasons this one is an example within; none of them again."""
    hints = get_type_hints(reason, include_extras=True)
    values = {
        field.name: _values(hints[field.name], (*inside, reason))
        for field in fields(reason)  # type: ignore[arg-type]
        if field.name != "code"
    }
    first = {name: options[0] for name, options in values.items()}
    others = [{**first, name: option} for name, options in values.items() for option in options[1:]]
    return [reason(**chosen) for chosen in (first, *others)]


def _holds_another(reason: type[Reason]) -> bool:
    """Whether it may hold any other reason, without end."""
    return any(Reason in (hint, *get_args(hint)) for hint in get_type_hints(reason).values())


def _values(hint: Any, inside: tuple[type, ...]) -> Sequence[object]:
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return _values(arguments[0], inside)
    if origin is Literal:
        return arguments
    if origin in (Union, UnionType):
        return [value for one in arguments if one not in inside for value in _values(one, inside)]
    if hint is Reason:
        return [example(one) for one in reason_classes() if not _holds_another(one)]
    if origin is tuple and arguments[-1] is Ellipsis:
        items = _values(arguments[0], inside)
        return [tuple(items[:1]), tuple(items[:1]) * 2, *((item,) for item in items[1:])]
    if origin is tuple:
        return [tuple(_values(one, inside)[0] for one in arguments)]
    if hint in PLAIN:
        return PLAIN[hint]
    if is_dataclass(hint):
        return _instances(hint, inside)  # type: ignore[arg-type]
    raise TypeError(f"{inside[-1].__name__}: {hint} is no type for a reason's value")
