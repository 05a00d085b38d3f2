from __future__ import annotations

from hardware.sim.autopilot.radio import Radio


def test_a_packet_comes_out_when_its_time_has_come_and_none_overtakes() -> None:
    radio = Radio()
    radio.put(b"late", 2.0)
    radio.put(b"sent after it, on a radio that has become faster", 1.0)

    assert list(radio.arrived(1.9)) == []
    assert list(radio.arrived(2.0)) == [b"late", b"sent after it, on a radio that has become faster"]
    assert list(radio.arrived(9.0)) == []
