"""The server's side: any order of messages passes each sample on once, and any garbage is refused politely."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.payload.messages import MAXIMUM_MESSAGE_BYTES, PROTOCOL
from hardware.payload.session import PayloadHub, PayloadSession, Subscription
from hardware.readings import Channel, Pulses
from hardware.reasons.payload import PayloadListening, PayloadStateUnknown

TOKEN = "a-token-of-some-length"


def hub() -> PayloadHub:
    return PayloadHub((TOKEN,), now=lambda: 5000.0)


def hello(first_seq: int = 1, agent: str = "pi", stream: str = "s1", protocol: int = PROTOCOL) -> str:
    return json.dumps(
        {
            "type": "hello",
            "protocol": protocol,
            "agent": agent,
            "stream": stream,
            "software": "test",
            "first_seq": first_seq,
        }
    )


def batch(first: int, count: int, oldest: int = 1, offset: float | None = None) -> str:
    rows = [[float(k), 868e6, -60.0, None, False, k % 2 == 0] for k in range(first, first + count)]
    return json.dumps(
        {"type": "samples", "first_seq": first, "oldest_seq": oldest, "clock_offset_s": offset, "samples": rows}
    )


def answers(session: PayloadSession) -> list[dict]:
    found = []
    while not session.outgoing.empty():
        found.append(json.loads(session.outgoing.get_nowait()))
    return found


def drained(subscription: Subscription) -> list[float]:
    return [s.at_s for s in subscription._samples]


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(st.integers(1, 40), st.integers(1, 12), st.booleans()), max_size=30))
def test_each_number_is_passed_on_once_in_order_whatever_is_resent(steps: list[tuple[int, int, bool]]) -> None:
    server = hub()
    subscription = server.subscribe()
    session = PayloadSession(server)
    session.receive(hello())
    for first, count, reconnect in steps:
        if reconnect:
            session.close()
            session = PayloadSession(server)
            session.receive(hello())
        session.receive(batch(first, count))
    got = drained(subscription)
    assert got == [float(k) for k in range(1, len(got) + 1)]
    last = [a["seq"] for a in answers(session) if a["type"] in {"ack", "resend"}]
    assert not last or last[-1] == len(got)


def test_gap_is_asked_for_again_and_what_the_agent_lost_is_not() -> None:
    server = hub()
    session = PayloadSession(server)
    session.receive(hello())
    session.receive(batch(5, 2))
    session.receive(batch(5, 2, oldest=5))
    assert [a for a in answers(session) if a["type"] != "welcome"] == [
        {"type": "resend", "seq": 0},
        {"type": "ack", "seq": 6},
    ]


def test_server_that_forgot_goes_on_where_the_agent_still_has_samples() -> None:
    server = hub()
    session = PayloadSession(server)
    session.receive(hello(first_seq=901))
    (welcome,) = answers(session)
    assert welcome["received_seq"] == 900


def test_agents_clock_is_corrected_and_its_channels_are_told() -> None:
    server = hub()
    server.tune([Channel(433e6)])
    subscription = server.subscribe()
    session = PayloadSession(server)
    session.receive(hello())
    carrier = {"frequency_hz": 433e6, "pulses": None, "others": []}
    assert answers(session)[0]["channels"] == [carrier]
    server.tune([Channel(433e6), Channel(150e6, Pulses(0.02, 1.3, 0.05))])
    tag = {"frequency_hz": 150e6, "pulses": {"width_s": 0.02, "period_s": 1.3, "jitter_s": 0.05}, "others": []}
    assert answers(session) == [{"type": "tune", "channels": [carrier, tag]}]
    session.receive(batch(1, 1, offset=3.0))
    assert drained(subscription) == [4.0]


def test_second_connection_of_an_agent_replaces_the_first() -> None:
    server = hub()
    first, second = PayloadSession(server), PayloadSession(server)
    first.receive(hello())
    second.receive(hello())
    assert first.refused
    first.close()
    assert server.agents["pi"].connected
    second.close()
    assert not server.agents["pi"].connected


def status(receiver: object) -> str:
    return json.dumps(
        {
            "type": "status",
            "receiver": receiver,
            "receiver_ok": True,
            "temperature_c": 51.5,
            "clock_offset_s": 0.02,
            "round_trip_s": 0.05,
            "clipped_percent": 2.5,
            "waiting": 7,
            "lost": 0,
        }
    )


def test_status_is_shown() -> None:
    server = hub()
    session = PayloadSession(server)
    session.receive(hello())
    session.receive(status({"code": "payload_listening", "channels": 2}))
    state = server.agents["pi"]
    assert (state.temperature_c, state.waiting, state.clipped_percent, state.receiver_ok) == (51.5, 7, 2.5, True)
    assert state.heard_at_s == 5000.0
    assert state.receiver == PayloadListening(2)


def test_a_state_that_this_server_does_not_know_is_no_reason_to_lose_the_samples() -> None:
    server = hub()
    session = PayloadSession(server)
    session.receive(hello())
    session.receive(status({"code": "from_the_future", "depth_m": 3.0}))
    assert server.agents["pi"].receiver == PayloadStateUnknown("from_the_future")
    session.receive(batch(1, 1))
    assert not session.refused


@pytest.mark.parametrize(("theirs", "behind"), [(PROTOCOL - 1, "payload's software"), (PROTOCOL + 1, "server")])
def test_another_version_is_told_who_is_behind_in_words_that_it_can_read(theirs: int, behind: str) -> None:
    session = PayloadSession(hub())
    session.receive(hello(protocol=theirs))
    (refusal,) = answers(session)
    assert refusal["reason"] == (
        f"The payload speaks version {theirs} of the protocol, the server version {PROTOCOL}. Update the {behind}."
    )


@pytest.mark.parametrize(
    ("messages", "words"),
    [
        ([batch(1, 1)], "did not say hello first"),
        ([hello(), hello()], "twice"),
        ([hello(protocol=9)], "Update the server"),
        (["x" * (MAXIMUM_MESSAGE_BYTES + 1)], "longer than"),
        ([hello(), '{"type":"samples","first_seq":1,"oldest_seq":1,"clock_offset_s":null,"samples":[]}'], "samples"),
        ([hello(), batch(1, 1).replace("-60.0", "NaN")], "was not understood"),
        ([hello(), batch(1, 1).replace("-60.0", "1e999")], "was not understood"),
        ([hello(), batch(0, 1)], "first_seq"),
    ],
)
def test_what_cannot_be_is_refused_with_a_sentence(messages: list[str], words: str) -> None:
    session = PayloadSession(hub())
    for message in messages:
        session.receive(message)
    assert session.refused
    refusal = answers(session)[-1]
    assert refusal["type"] == "refused"
    assert words in refusal["reason"]


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=12), inner, max_size=5),
    max_leaves=12,
)
FIELDS = st.fixed_dictionaries(
    {"type": st.sampled_from(["hello", "samples", "status", "ping", "welcome", "other"])},
    optional=dict.fromkeys(
        ["protocol", "agent", "stream", "software", "first_seq", "oldest_seq", "samples", "agent_s", "waiting"], JSON
    ),
)


@settings(max_examples=150, deadline=None)
@given(
    st.lists(st.one_of(st.text(max_size=80), st.binary(max_size=80), FIELDS.map(json.dumps)), max_size=6), st.booleans()
)
def test_fuzzed_messages_never_crash_and_never_pass_a_wrong_sample(messages: list[str | bytes], greeted: bool) -> None:
    server = hub()
    subscription = server.subscribe()
    session = PayloadSession(server)
    if greeted:
        session.receive(hello())
    for message in messages:
        session.receive(message)
    session.close()
    assert drained(subscription) == []


def test_tokens_are_compared_and_short_ones_refused() -> None:
    assert hub().authenticate(TOKEN)
    assert not hub().authenticate("")
    assert not hub().authenticate(TOKEN + "x")
    with pytest.raises(ValueError, match="16 characters"):
        PayloadHub(("short",))


async def test_slow_reader_loses_the_oldest_and_it_is_counted() -> None:
    server = hub()
    subscription = server.subscribe()
    subscription.capacity = 10
    session = PayloadSession(server)
    session.receive(hello())
    session.receive(batch(1, 25))
    assert subscription.dropped == 15
    assert (await subscription.get()).at_s == 16.0
