"""Every reason of the hardware as one type."""

from hardware.reasons.antenna import AntennaReason
from hardware.reasons.channels import ChannelReason
from hardware.reasons.iq_recording import IqRecordingReason
from hardware.reasons.nets import NetsReason
from hardware.reasons.on_the_way import NoseSwung, ReadingsLeftOut
from hardware.reasons.pattern import PatternReason
from hardware.reasons.payload import PayloadReason
from hardware.reasons.payload_link import PayloadLinkReason
from hardware.reasons.preflight import PreflightReason
from hardware.reasons.radio import RadioReason
from hardware.reasons.receiver import ReceiverReason
from hardware.reasons.simulation import SimulationReason
from hardware.reasons.sweep import SweepReason, SweepRemark
from hardware.reasons.table import TableReason
from hardware.reasons.vehicle import VehicleReason
from hardware.reasons.vehicle_news import VehicleNews

HardwareReason = (
    ReceiverReason
    | ChannelReason
    | RadioReason
    | PayloadReason
    | PayloadLinkReason
    | SimulationReason
    | SweepReason
    | SweepRemark
    | NoseSwung
    | ReadingsLeftOut
    | AntennaReason
    | PatternReason
    | TableReason
    | IqRecordingReason
    | VehicleReason
    | VehicleNews
    | PreflightReason
    | NetsReason
)

RecordingReason = TableReason | IqRecordingReason
"""Why a recording cannot be used, or what of it is left out or assumed."""
