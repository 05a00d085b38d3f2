"""What the Remote ID transmitter (OpenDroneID) says of itself, by OPEN_DRONE_ID_ARM_STATUS. Pure."""

from __future__ import annotations

from dataclasses import dataclass

from hardware.autopilot.words import sanitized

ARM_STATUS = "OPEN_DRONE_ID_ARM_STATUS"
_GOOD_TO_ARM = 0  # MAV_ODID_ARM_STATUS_GOOD_TO_ARM


@dataclass(frozen=True, slots=True)
class RemoteId:
    """at_s: when it was heard last (UTC), None: never. problem: why the vehicle must not arm, None: it may."""

    at_s: float | None = None
    problem: str | None = None


def remote_id(status: int, error: str, heard_at_s: float) -> RemoteId:
    """status: MAV_ODID_ARM_STATUS; error: the transmitter's own words, not to be trusted."""
    if status == _GOOD_TO_ARM:
        return RemoteId(heard_at_s)
    return RemoteId(heard_at_s, sanitized(error) or f"arm status {status}")
