"""An autopilot's own nets: the fence it holds, the parameters that make it act, and what a mission wants of them.

Places: WGS84. Heights: metres above home.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from hardware.readings import Place


@dataclass(frozen=True, slots=True)
class FencePolygon:
    """corners: at least three, the first not repeated. inside: the vehicle stays in it, else out of it."""

    corners: tuple[Place, ...]
    inside: bool
    kind: Literal["polygon"] = "polygon"


@dataclass(frozen=True, slots=True)
class FenceCircle:
    """inside: the vehicle must stay in it, else out of it."""

    centre: Place
    radius_m: float
    inside: bool
    kind: Literal["circle"] = "circle"


@dataclass(frozen=True, slots=True)
class FenceReturnPoint:
    """Where ArduPilot may return to after a breach; it bounds nothing."""

    place: Place
    kind: Literal["return_point"] = "return_point"


FenceZone = FencePolygon | FenceCircle | FenceReturnPoint


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """By the autopilot's own name, in its own unit."""

    parameter: str
    value: float


@dataclass(frozen=True, slots=True)
class Nets:
    """What an autopilot holds. parameters: those of its fence that this version has."""

    zones: tuple[FenceZone, ...] = ()
    parameters: tuple[ParameterValue, ...] = ()

    def values(self) -> dict[str, float]:
        """By parameter."""
        return {one.parameter: one.value for one in self.parameters}


@dataclass(frozen=True, slots=True)
class MissionNets:
    """What a mission wants. needed, ceiling_m: where it may fly, up to the very edge. zones, net_ceiling_m: where the
    net is to hang, a little outside."""

    home: Place
    needed: tuple[FencePolygon, ...]
    zones: tuple[FencePolygon, ...]
    ceiling_m: float
    net_ceiling_m: float


@dataclass(frozen=True, slots=True)
class NetsPlan:
    """before: as the owner has them. after: as they are to be for the mission."""

    before: Nets
    after: Nets
