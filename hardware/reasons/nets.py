"""The autopilot's own nets: what the mission sets on the vehicle, and why it cannot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class ParameterToSet:
    parameter: str
    before: float
    after: float
    code: Literal["parameter_to_set"] = "parameter_to_set"

    english: ClassVar[Words] = Words("{parameter} goes from {before} to {after}.")


@dataclass(frozen=True, slots=True)
class NetsToSet:
    """What the start puts into the autopilot. corners: of all polygons; own_zones: of the owner's fence that make room
    meanwhile."""

    corners: int
    no_fly: int
    own_zones: int
    changes: tuple[ParameterToSet, ...]
    code: Literal["nets_to_set"] = "nets_to_set"

    english: ClassVar[Words] = Words(
        "The start sets the autopilot's own fence: {corners|corner|corners}, {no_fly|no-fly area|no-fly areas}. "
        "{own_zones?0=It holds no other|*=Its own makes room meanwhile}; "
        "after the flight everything is put back as it was. {changes}"
    )


@dataclass(frozen=True, slots=True)
class OwnCeilingLower:
    """own_m, ceiling_m: above home."""

    parameter: str
    own_m: float
    ceiling_m: float
    code: Literal["own_ceiling_lower"] = "own_ceiling_lower"

    english: ClassVar[Words] = Words(
        "The autopilot's own fence ends at {own_m} ({parameter}), the mission's at {ceiling_m}.",
        "Lower the mission's ceiling, or raise {parameter} with the vehicle's ground station.",
    )


@dataclass(frozen=True, slots=True)
class OwnFenceTighter:
    """beyond_m: so far the mission's fence reaches beyond the owner's."""

    beyond_m: float
    code: Literal["own_fence_tighter"] = "own_fence_tighter"

    english: ClassVar[Words] = Words(
        "The mission's fence reaches {beyond_m} beyond the fence that the autopilot holds already.",
        "Draw the mission's fence inside it, or change the vehicle's own with its ground station.",
    )


@dataclass(frozen=True, slots=True)
class FenceTooDetailed:
    corners: int
    most: int
    code: Literal["fence_too_detailed"] = "fence_too_detailed"

    english: ClassVar[Words] = Words(
        "Fence and no-fly areas have {corners|corner|corners}; the autopilot can hold {most}.",
        "Draw them with fewer corners.",
    )


@dataclass(frozen=True, slots=True)
class FenceNotTransferred:
    """why: the library's word for what happened."""

    way: Literal["read", "sent"]
    why: str
    code: Literal["fence_not_transferred"] = "fence_not_transferred"

    english: ClassVar[Words] = Words(
        "The autopilot's fence could not be {way?read=read|sent=sent} ({why}).",
        "Check the link; a fence on the autopilot's storage card may be damaged.",
    )


@dataclass(frozen=True, slots=True)
class FenceUnknownForm:
    """what: the first thing that is not understood."""

    what: str
    code: Literal["fence_unknown_form"] = "fence_unknown_form"

    english: ClassVar[Words] = Words(
        "The autopilot holds a fence that Crossfix does not understand ({what}).",
        "Look at it with the vehicle's ground station, and clear it there.",
    )


@dataclass(frozen=True, slots=True)
class FenceReadBackDifferent:
    """corner: the first that differs, from 1."""

    corner: int
    code: Literal["fence_read_back_different"] = "fence_read_back_different"

    english: ClassVar[Words] = Words(
        "The autopilot holds another fence than it was sent: corner {corner} differs.",
        "Try again; when it stays so, set the fence with the vehicle's ground station.",
    )


@dataclass(frozen=True, slots=True)
class FenceParameterUnread:
    parameter: str
    code: Literal["fence_parameter_unread"] = "fence_parameter_unread"

    english: ClassVar[Words] = Words(
        "The autopilot's fence cannot be judged: {parameter} could not be read.", "Check the link and try again."
    )


NetsReason = (
    ParameterToSet
    | NetsToSet
    | OwnCeilingLower
    | OwnFenceTighter
    | FenceTooDetailed
    | FenceNotTransferred
    | FenceUnknownForm
    | FenceReadBackDifferent
    | FenceParameterUnread
)
