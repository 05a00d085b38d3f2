"""The SoapySDR adapter without a radio: clear errors, and the calls it makes, against a stand-in module."""

from __future__ import annotations

import sys
import types
from typing import Any

import numpy as np
import pytest

from hardware.ports import ReceiverError
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.soapy import SoapySource


async def test_absent_module_and_unnamed_driver_are_clear_errors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SoapySDR", None)
    with pytest.raises(ReceiverError, match="python3-soapysdr"):
        await SoapySource("driver=rtlsdr").open(868e6)
    with pytest.raises(ReceiverError, match="driver"):
        SoapySource("serial=1")


class FakeDevice:
    """Streams a tone 15 % of the rate below the centre, one overflow, one timeout; then breaks."""

    def __init__(self, text: str) -> None:
        self.calls: dict[str, Any] = {"device": text}
        self.reads = 0

    def __getattr__(self, name: str) -> Any:
        if name.startswith("set") and name != "setupStream":
            return lambda direction, channel, value: self.calls.__setitem__(name, value)
        if name in {"activateStream", "deactivateStream", "closeStream"}:
            return lambda stream: self.calls.__setitem__(name, stream)
        raise AttributeError(name)

    def getSampleRate(self, direction: int, channel: int) -> float:
        return self.calls["setSampleRate"]

    def getFrequency(self, direction: int, channel: int) -> float:
        return self.calls["setFrequency"]

    def setupStream(self, direction: int, kind: str, channels: list[int]) -> str:
        return "stream"

    def readStream(self, stream: str, buffers: list[np.ndarray], size: int, timeoutUs: int) -> Any:
        self.reads += 1
        special = {2: -4, 3: -1, 40: -2}
        if self.reads in special:
            return types.SimpleNamespace(ret=special[self.reads])
        t = (self.reads * size + np.arange(size)) / self.calls["setSampleRate"]
        buffers[0][:] = 0.1 * np.exp(-2j * np.pi * 0.15 * self.calls["setSampleRate"] * t)
        return types.SimpleNamespace(ret=size)


async def test_power_and_faults_of_a_stream(monkeypatch: pytest.MonkeyPatch) -> None:
    devices: list[FakeDevice] = []
    module = types.ModuleType("SoapySDR")
    constants = {"SOAPY_SDR_RX": 1, "SOAPY_SDR_CF32": "CF32", "SOAPY_SDR_TIMEOUT": -1, "SOAPY_SDR_OVERFLOW": -4}
    for name, value in constants.items():
        setattr(module, name, value)
    module.Device = lambda text: devices.append(FakeDevice(text)) or devices[-1]  # type: ignore[attr-defined]
    module.errToStr = lambda code: f"STREAM_ERROR {code}"  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "SoapySDR", module)
    receiver = IqReceiver(SoapySource("driver=fake", 100_000.0, gain_db=20.0))
    await receiver.open(868e6)
    heard = []

    async def listen() -> None:
        async for sample in receiver.samples():
            heard.append(sample)  # noqa: PERF401 - what came before the fault counts

    with pytest.raises(ReceiverError, match="STREAM_ERROR"):
        await listen()
    assert [s.power_db for s in heard] == pytest.approx([-20.0 - 20.0] * len(heard), abs=0.3)
    assert len(heard) > 5
    assert receiver.lost_samples > 0
    assert devices[0].calls["setGainMode"] is False
    assert devices[0].calls["setGain"] == 20.0
    await receiver.close()
    assert devices[0].calls["closeStream"] == "stream"
