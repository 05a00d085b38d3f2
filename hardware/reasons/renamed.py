"""A file that lies under another name is called by its owner's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

R = TypeVar("R", bound="DataclassInstance")


def renamed(reason: R, names: Mapping[str, str]) -> R:
    """The reason, and those inside it, with `names[path]` wherever a value, also a library's message, holds `path`."""
    changed: dict[str, Any] = {}
    for field in fields(reason):
        value = getattr(reason, field.name)
        if is_dataclass(value) and not isinstance(value, type):
            changed[field.name] = renamed(value, names)
        elif isinstance(value, str) and field.name != "code":
            for path, name in names.items():
                value = value.replace(path, name)
            changed[field.name] = value
    return replace(reason, **changed)
