"""Receivers by name: "soapy:driver=rtlsdr", "rtl_tcp://host:port", "sigmf:FILE", "recording:FILE"."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import urlsplit

from hardware.direction_finding.recordings import read_recording
from hardware.direction_finding.table_file import RecordingError
from hardware.ports import Clock, Receiver, ReceiverError
from hardware.reasons.receiver import ReceiverMisnamed
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.recorded import RecordedReceiver
from hardware.sdr.rtl_tcp import RtlTcpSource
from hardware.sdr.soapy import SoapySource

FORMS = "soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE or recording:FILE"
DEFAULT_RATE_HZ = 250_000.0
DEFAULT_GAIN_DB = 28.0


def receiver_from(
    device: str,
    clock: Clock,
    sample_rate_hz: float = DEFAULT_RATE_HZ,
    gain_db: float = DEFAULT_GAIN_DB,
) -> Receiver:
    """The receiver that `device` names; nothing is opened yet. Raises ReceiverError when the name is not understood."""
    kind, _, rest = device.partition(":")
    if kind == "soapy" and rest:
        return IqReceiver(SoapySource(rest, sample_rate_hz, gain_db))
    if kind == "rtl_tcp" and rest.startswith("//"):
        parts = urlsplit(rest)  # without the scheme: an underscore is not valid in one
        try:
            port = parts.port or 1234
        except ValueError:
            raise ReceiverError(ReceiverMisnamed(device, "port")) from None
        if not parts.hostname:
            raise ReceiverError(ReceiverMisnamed(device, "host"))
        return IqReceiver(RtlTcpSource(parts.hostname, port, sample_rate_hz, gain_db))
    if kind == "sigmf" and rest:
        from hardware.sdr.sigmf_playback import SigmfSource  # a quarter of the payload's start, which seldom plays one

        return IqReceiver(SigmfSource(Path(rest), clock))
    if kind == "recording" and rest:
        try:
            return RecordedReceiver(read_recording(rest).sweeps[0].sweep, clock)
        except RecordingError as error:
            raise ReceiverError(error.reason) from error
    raise ReceiverError(ReceiverMisnamed(device, "form"))
