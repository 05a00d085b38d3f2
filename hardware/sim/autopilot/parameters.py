"""The parameters an autopilot lets one read and set, as MAVLink types them."""

from __future__ import annotations

import struct
from dataclasses import dataclass

INT32, REAL32, INT8, INT16 = 6, 9, 2, 4
"""MAV_PARAM_TYPE."""


@dataclass(slots=True)
class Parameter:
    """kind: MAV_PARAM_TYPE."""

    value: float
    kind: int


class Parameters:
    """Named values. `bytewise`: integers travel as bytes in the float field (PX4), else as numbers (ArduPilot)."""

    def __init__(self, defaults: dict[str, tuple[float, int]], bytewise: bool) -> None:
        self._table = {name: Parameter(value, kind) for name, (value, kind) in defaults.items()}
        self.bytewise = bytewise

    def __getitem__(self, name: str) -> float:
        return self._table[name].value

    def __contains__(self, name: str) -> bool:
        return name in self._table

    def __len__(self) -> int:
        return len(self._table)

    def names(self) -> list[str]:
        """In the order in which PARAM_VALUE numbers them."""
        return sorted(self._table)

    def kind(self, name: str) -> int:
        """MAV_PARAM_TYPE. Raises KeyError for a parameter it has not."""
        return self._table[name].kind

    def set(self, name: str, value: float) -> None:
        """Raises ValueError when this autopilot has no such parameter."""
        if name not in self._table:
            raise ValueError(f"This autopilot has no parameter {name}; it has {', '.join(self.names())}.")
        parameter = self._table[name]
        parameter.value = float(value) if parameter.kind == REAL32 else float(round(value))

    def encode(self, name: str) -> float:
        """The value as the float of PARAM_VALUE."""
        parameter = self._table[name]
        if self.bytewise and parameter.kind != REAL32:
            return struct.unpack("<f", struct.pack("<i", int(parameter.value)))[0]
        return parameter.value

    def decode(self, name: str, wire: float) -> float:
        """The float of PARAM_SET as a value."""
        if self.bytewise and self._table[name].kind != REAL32:
            return float(struct.unpack("<i", struct.pack("<f", wire))[0])
        return wire
