"""The SoapySDR adapter without a radio, against a stand-in module that behaves as real drivers did (0.8.1: RTL-SDR,
audio, remote): bursts, nothing at once, exceptions, a device that stays busy until it is freed."""

from __future__ import annotations

import asyncio
import sys
import threading
import time
import types
from typing import Any, ClassVar

import numpy as np
import pytest

from hardware.ports import ReceiverError
from hardware.readings import Channel
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.soapy import SoapySource

RATE_HZ = 100_000.0
BURST = 6000
TIMEOUT, BROKEN, OVERFLOW = -1, -2, -4


class FakeDevice:
    """Streams a tone 15 % of the rate below the centre in bursts. `script`: what a read by its number does instead."""

    script: ClassVar[dict[int, int | Exception]] = {}
    quirks: ClassVar[dict[str, Any]] = {}
    opened: ClassVar[list[FakeDevice]] = []

    def __init__(self, text: str) -> None:
        if any(not device.freed for device in self.opened):
            raise RuntimeError("Unable to open the device")
        self.opened.append(self)
        self.calls: dict[str, Any] = {"device": text}
        self.reads, self.freed = 0, False
        self.reading, self.began = threading.Lock(), threading.Event()

    def getNumChannels(self, direction: int) -> int:
        return self.quirks.get("channels", 1)

    def getSettingInfo(self) -> list[Any]:
        return [types.SimpleNamespace(key="biastee")]

    def getStreamArgsInfo(self, direction: int, channel: int) -> list[Any]:
        return [types.SimpleNamespace(key="bufflen")]

    def writeSetting(self, key: str, value: str) -> None:
        self.calls[key] = value

    def setSampleRate(self, direction: int, channel: int, value: float) -> None:
        self.calls["rate"] = value

    def getSampleRate(self, direction: int, channel: int) -> float:
        return self.calls["rate"]

    def setFrequency(self, direction: int, channel: int, value: float) -> None:
        self.calls["frequency"] = value

    def getFrequency(self, direction: int, channel: int) -> float:
        return self.quirks.get("frequency", self.calls["frequency"])

    def setGainMode(self, direction: int, channel: int, automatic: bool) -> None:
        self.calls["automatic"] = automatic

    def setGain(self, direction: int, channel: int, value: float) -> None:
        self.calls["gain"] = value

    def getGain(self, direction: int, channel: int) -> float:
        return 5.0 * round(self.calls["gain"] / 5.0)

    def setupStream(self, direction: int, kind: str, channels: list[int], arguments: dict[str, str]) -> str:
        self.calls["stream"] = arguments
        return "stream"

    def getStreamMTU(self, stream: str) -> int:
        return BURST

    def activateStream(self, stream: str) -> int:
        return self.quirks.get("activate", 0)

    def readStream(self, stream: str, buffers: list[np.ndarray], size: int, timeoutUs: int) -> Any:
        with self.reading:
            self.began.set()
            self.reads += 1
            told = self.script.get(self.reads, self.script.get(0, BURST))
            if isinstance(told, Exception):
                raise told
            if told == TIMEOUT:
                time.sleep(timeoutUs * 1e-6)
            if told > 0:
                time.sleep(0.005)
                t = (self.reads * BURST + np.arange(BURST)) / RATE_HZ
                buffers[0][:told] = self.quirks.get("level", 0.1) * np.exp(-2j * np.pi * 0.15 * RATE_HZ * t)[:told]
        return types.SimpleNamespace(ret=told, flags=0, timeNs=0)

    def deactivateStream(self, stream: str) -> None:
        if isinstance(self.script.get(0), Exception):
            raise self.script[0]  # type: ignore[misc]

    def closeStream(self, stream: str) -> None:
        assert self.reading.acquire(blocking=False), "closed while it was read"
        self.calls["closed"] = stream

    def close(self) -> None:
        self.freed = True


@pytest.fixture
def device(monkeypatch: pytest.MonkeyPatch) -> type[FakeDevice]:
    module = types.ModuleType("SoapySDR")
    constants = {"SOAPY_SDR_RX": 1, "SOAPY_SDR_CF32": "CF32", "SOAPY_SDR_TIMEOUT": TIMEOUT}
    constants |= {"SOAPY_SDR_OVERFLOW": OVERFLOW, "SOAPY_SDR_CORRUPTION": -3}
    for name, value in constants.items():
        setattr(module, name, value)
    module.Device = FakeDevice  # type: ignore[attr-defined]
    module.errToStr = lambda code: f"STREAM_ERROR {code}"  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "SoapySDR", module)
    for name in ("script", "quirks", "opened"):
        monkeypatch.setattr(FakeDevice, name, type(getattr(FakeDevice, name))())
    return FakeDevice


async def hear(receiver: IqReceiver, count: int) -> list[Any]:
    await receiver.open([Channel(868e6)])
    heard = []
    async for sample in receiver.samples():
        heard.append(sample)
        if len(heard) >= count:
            break
    await receiver.close()
    return heard


async def test_absent_module_and_device_strings_that_would_search_are_clear_errors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "SoapySDR", None)
    with pytest.raises(ReceiverError, match="SoapySDR is not installed"):
        await SoapySource("driver=rtlsdr").open(868e6)
    for text in ("serial=1", "driver=", "xdriver=rtlsdr"):
        with pytest.raises(ReceiverError, match="names no driver"):
            SoapySource(text)
    with pytest.raises(ReceiverError, match="names no server"):
        SoapySource("driver=remote")


async def test_power_is_measured_with_the_gain_that_the_radio_took(device: type[FakeDevice]) -> None:
    receiver = IqReceiver(SoapySource("driver=fake, bufflen=16384,biastee=true,serial=7", RATE_HZ, gain_db=21.0))
    heard = await hear(receiver, 6)
    assert [s.power_db for s in heard] == pytest.approx([-20.0 - 20.0] * len(heard), abs=0.3)
    calls = device.opened[0].calls
    assert calls["automatic"] is False
    assert calls["stream"] == {"bufflen": "16384"}
    assert calls["biastee"] == "true"
    assert calls["closed"] == "stream"


async def test_a_burst_is_read_whole_so_that_its_time_is_known(device: type[FakeDevice]) -> None:
    source = SoapySource("driver=fake", RATE_HZ)
    await source.open(868e6)
    block = await anext(aiter(source.blocks()))
    assert block.samples.size == BURST
    assert block.at_s <= time.time() - BURST / RATE_HZ
    await source.close()


async def test_an_overflow_is_a_gap_and_a_timeout_is_none(device: type[FakeDevice]) -> None:
    device.script.update({2: OVERFLOW, 4: TIMEOUT})
    receiver = IqReceiver(SoapySource("driver=fake", RATE_HZ))
    await hear(receiver, 3)
    assert receiver.lost_percent > 0.0
    device.script.pop(2)
    await hear(receiver, 3)
    assert receiver.lost_percent == 0.0


async def test_full_scale_of_an_8_bit_converter_is_flagged_as_clipped(device: type[FakeDevice]) -> None:
    device.quirks["level"] = (255 - 127.4) / 128.0
    assert all(s.clipped for s in await hear(IqReceiver(SoapySource("driver=fake", RATE_HZ)), 3))
    device.quirks["level"] = 0.98
    assert not any(s.clipped for s in await hear(IqReceiver(SoapySource("driver=fake", RATE_HZ)), 3))


@pytest.mark.parametrize(
    ("gone", "told"),
    [
        (BROKEN, "STREAM_ERROR -2"),
        (RuntimeError("recv() connection closed"), "connection closed"),
        (TIMEOUT, "delivered nothing"),
        (0, "delivered nothing"),
        (OVERFLOW, "delivered nothing"),
    ],
)
async def test_a_radio_that_vanishes_is_told_freed_and_opened_again(
    device: type[FakeDevice], gone: int | Exception, told: str
) -> None:
    device.script.update(dict.fromkeys(range(1, 4), BURST) | {0: gone})
    receiver = IqReceiver(SoapySource("driver=fake", RATE_HZ), silent_after_s=0.3)
    with pytest.raises(ReceiverError, match=told):
        await hear(receiver, 1000)
    await receiver.close()
    device.script.clear()
    assert len(await hear(receiver, 3)) == 3
    assert [d.freed for d in device.opened] == [True, True]


async def test_closing_waits_for_the_read_that_is_under_way(device: type[FakeDevice]) -> None:
    device.script[0] = TIMEOUT
    source = SoapySource("driver=fake", RATE_HZ)
    await source.open(868e6)
    reading = asyncio.ensure_future(anext(aiter(source.blocks())))
    await asyncio.to_thread(device.opened[0].began.wait)
    reading.cancel()
    await source.close()
    assert device.opened[0].freed


@pytest.mark.parametrize(
    ("quirk", "told"),
    [
        ({"channels": 0}, "no receive channel"),
        ({"frequency": 0.0}, "tuned to 0.0 kHz"),
        ({"activate": -5}, "does not start"),
    ],
)
async def test_a_radio_that_cannot_is_told_and_freed(
    device: type[FakeDevice], quirk: dict[str, Any], told: str
) -> None:
    device.quirks.update(quirk)
    source = SoapySource("driver=fake", RATE_HZ)
    with pytest.raises(ReceiverError, match=told):
        await source.open(868e6)
    assert device.opened[0].freed


@pytest.mark.parametrize(("driver", "told"), [("null", "no receive channel"), ("no-such-radio", "no match")])
async def test_the_real_binding_says_what_is_wrong(driver: str, told: str) -> None:
    pytest.importorskip("SoapySDR")
    with pytest.raises(ReceiverError, match=told):
        await SoapySource(f"driver={driver}").open(868e6)
