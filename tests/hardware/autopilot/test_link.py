from __future__ import annotations

import pytest

from hardware.autopilot.link import MavlinkLink, check_url


@pytest.mark.parametrize(
    "url",
    ["udpin://0.0.0.0:14540", "udpout://10.0.0.2:14550", "tcpout://127.0.0.1:5760", "serial:///dev/ttyUSB0:57600"],
)
def test_mavsdks_addresses_pass_as_they_are(url: str) -> None:
    assert check_url(url) == url


def test_plain_tcp_means_to_connect_to_it() -> None:
    assert check_url("tcp://127.0.0.1:5760") == "tcpout://127.0.0.1:5760"


@pytest.mark.parametrize("url", ["", "14540", "udp://:14540", "http://vehicle", "udpin://"])
def test_other_addresses_are_refused_with_the_forms_there_are(url: str) -> None:
    with pytest.raises(ValueError, match=r"udpin://0\.0\.0\.0:14540"):
        check_url(url)


async def test_before_it_is_open_nothing_is_sent_and_closing_twice_is_harmless() -> None:
    link = MavlinkLink("udpin://127.0.0.1:14999", (), lambda name, fields: None)

    assert await link.send("HEARTBEAT", {}, lambda: True) is False
    assert await link.parameter("NAV_DLL_ACT") is None
    await link.close()
    await link.close()
