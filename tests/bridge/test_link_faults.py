# SPDX-License-Identifier: BSD-3-Clause
"""What a link with faults does to frames, and what it may be told to do."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.faulty_links import FaultyLinks
from sitl.bridge.frame import encode_v1, encode_v2
from sitl.bridge.links import InProcessLink, LinkFaults
from sitl.bridge.links.faulty_direction import FaultyDirection, cut, is_of_clock
from sitl.client.endpoint import Endpoint
from sitl.core.constants import NEVER
from sitl.errors import OptionError

FRAMES = [bytes([0xFD, 3, 0, 0, k & 0xFF, 1, 1, 0, k >> 8, 9, 1, 2, 3, 4, 5]) for k in range(2000)]
EVERY_US = 10_000


def test_a_log_has_no_faults() -> None:
    links = FaultyLinks()
    links.set(LinkFaults(loss=0.5), None)
    client, log = (SimpleNamespace(peer=SimpleNamespace(is_log=is_log)) for is_log in (False, True))
    assert links.of(client) == LinkFaults(loss=0.5) and links.of(log) is None


def carried(faults: LinkFaults, frames: list[bytes] = FRAMES, stream: int = 0) -> list[tuple[int, bytes]]:
    """Frames sent every 10 ms: (time of arrival [us], frame)."""
    way, out = FaultyDirection(faults, stream), []
    for k, frame in enumerate(frames):
        now = k * EVERY_US
        while way.due_us <= now:
            out += [(due, f) for due in [way.due_us] for f in way.arrived(due)]
        out += [(now, f) for f in way.carry([frame], now)]
    while way.due_us != NEVER:
        out += [(due, f) for due in [way.due_us] for f in way.arrived(due)]
    return out


def number(frame: bytes) -> int:
    return frame[4] | frame[8] << 8


def test_without_faults_frames_pass_at_once() -> None:
    assert carried(LinkFaults()) == [(k * EVERY_US, frame) for k, frame in enumerate(FRAMES)]


def test_loss() -> None:
    out = carried(LinkFaults(loss=0.2))
    assert len(out) == pytest.approx(0.8 * len(FRAMES), abs=80)
    assert out == carried(LinkFaults(loss=0.2)) != carried(LinkFaults(loss=0.2, seed=1))
    assert out != carried(LinkFaults(loss=0.2), stream=1)
    assert carried(LinkFaults(loss=1.0)) == []


def test_delay_keeps_the_order() -> None:
    assert [due for due, _ in carried(LinkFaults(delay=0.25))] == [k * EVERY_US + 250_000 for k in range(len(FRAMES))]
    out = carried(LinkFaults(delay=(0.1, 0.3)))
    assert [number(frame) for _, frame in out] == list(range(len(FRAMES)))
    late = [due - number(frame) * EVERY_US for due, frame in out]
    assert 100_000 <= min(late) < 150_000 and 290_000 < max(late) <= 300_000


def test_jitter_is_about_the_delay_and_never_before_sending() -> None:
    sparse = FRAMES[:1] * 1
    late = [carried(LinkFaults(delay=0.1, jitter=0.3, seed=seed), sparse)[0][0] for seed in range(300)]
    assert min(late) == 0 and 350_000 < max(late) <= 400_000


def test_duplicates() -> None:
    out = carried(LinkFaults(duplicates=0.3, delay=(0.0, 0.05)))
    assert len(out) == pytest.approx(1.3 * len(FRAMES), abs=100)
    assert {frame for _, frame in out} == set(FRAMES)


def test_reordering_lets_others_pass() -> None:
    order = [number(frame) for _, frame in carried(LinkFaults(reordering=0.1))]
    assert sorted(order) == list(range(len(FRAMES)))
    overtaken = [k for k, n in enumerate(order) if n < max(order[: k + 1])]
    assert 0.05 * len(FRAMES) < len(overtaken) < 0.13 * len(FRAMES)


def test_corruption_turns_bits_over() -> None:
    out = carried(LinkFaults(corruption=0.001))
    bits = sum((a ^ b).bit_count() for (_, frame), sent in zip(out, FRAMES) for a, b in zip(frame, sent))
    assert bits == pytest.approx(0.001 * 8 * sum(map(len, FRAMES)), rel=0.25)
    assert carried(LinkFaults(corruption=1.0), FRAMES[:1]) == [(0, bytes(b ^ 0xFF for b in FRAMES[0]))]


def test_bandwidth_makes_frames_wait_and_loses_what_waits_too_long() -> None:
    size = len(FRAMES[0])
    out = carried(LinkFaults(bandwidth=size * 10.0), FRAMES[:1000])  # ten frames a second; a hundred come
    times = [due for due, _ in out]
    assert {b - a for a, b in pairwise(times)} == {100_000}
    assert len(out) == pytest.approx(140, abs=3)  # those of 10 s, and 4 s of them in wait
    way = FaultyDirection(LinkFaults(bandwidth=size * 10.0))
    assert way.carry(FRAMES[:2], 0) == [] and not way.is_full
    way.carry(FRAMES[:2], 0)
    assert way.is_full
    way.arrived(200_000)
    assert not way.is_full


def test_cuts() -> None:
    out = carried(LinkFaults(cuts=((1.0, 2.0), (5.0, 1e9))))
    assert [number(frame) for _, frame in out] == [*range(100), *range(200, 500)]


def test_a_way_goes_on_from_its_state() -> None:
    faults = LinkFaults(loss=0.2, delay=(0.1, 0.3), duplicates=0.1, reordering=0.1, corruption=1e-3, bandwidth=5000.0)
    way = FaultyDirection(faults)
    for k, frame in enumerate(FRAMES[:500]):
        way.carry([frame], k * EVERY_US)
    copies = [FaultyDirection.restored(way.snapshot()) for _ in range(2)]
    heard = [[copy.carry([frame], k * EVERY_US) for k, frame in enumerate(FRAMES[500:], 500)] for copy in copies]
    assert heard[0] == heard[1] == [way.carry([frame], k * EVERY_US) for k, frame in enumerate(FRAMES[500:], 500)]


def test_bytes_are_cut_at_the_ends_of_frames() -> None:
    v1 = bytes([0xFE, 2, 7, 1, 1, 0, 8, 9, 1, 2])
    signed = bytes([0xFD, 1, 1, 0, 0, 1, 1, 0, 0, 0, 5, 1, 2]) + bytes(13)
    pieces = [b"\x00garbage", FRAMES[0], v1, signed, FRAMES[1]]
    stream = b"".join(pieces)
    assert cut(stream) == (pieces, b"")
    for k in range(len(stream)):
        first, rest = cut(stream[:k])
        again, end = cut(rest + stream[k:])
        assert b"".join(first + again) == stream and end == b""
        assert [p for p in first + again if p[0] in (0xFD, 0xFE)] == pieces[1:]


def test_the_push_of_a_clock_passes_unharmed() -> None:
    class Kept(InProcessLink):
        def send(self, data: bytes) -> None:
            sent.append(data)

    sent: list[bytes] = []
    endpoint = Endpoint(Kept())
    endpoint.send("COMMAND_INT", command=31010, x=5)
    endpoint.send("COMMAND_ACK", command=31010)
    endpoint.send("COMMAND_INT", command=400, x=31010)
    endpoint.send("COMMAND_ACK", command=400)
    assert [is_of_clock(frame) for frame in sent] == [True, True, False, False]
    assert FaultyDirection(LinkFaults(loss=1.0)).carry(sent, 0) == sent[:2]
    assert not any(is_of_clock(bytes([mark])[:1]) for mark in range(256))


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"loss": 1.2}, "loss 1.2 is not a share from 0 to 1"),
        ({"loss": float("nan")}, "loss nan"),
        ({"duplicates": -0.1}, "duplicates -0.1"),
        ({"reordering": True}, "reordering True"),
        ({"corruption": "1"}, "corruption '1'"),
        ({"delay": -0.2}, "delay -0.2 is not a time from 0 to 3600 s"),
        ({"delay": (0.4, 0.2)}, "(0.4, 0.2): the first time is longer"),
        ({"delay": (0.4,)}, "delay (0.4,)"),
        ({"jitter": float("inf")}, "jitter inf"),
        ({"bandwidth": 0.0}, "bandwidth 0.0 is not 10 bytes/s or more"),
        ({"cuts": ((5.0, 2.0),)}, "cut (5.0, 2.0) is not a pair"),
        ({"cuts": (5.0,)}, "cut 5.0 is not a pair"),
        ({"direction": "up"}, "direction 'up' is none of both, to-vehicle, to-client"),
        ({"seed": 1.5}, "seed 1.5 is not a whole number"),
    ],
)
def test_values_that_cannot_be(values: dict[str, Any], says: str) -> None:
    with pytest.raises(OptionError) as error:
        LinkFaults(**values)
    assert says in str(error.value)


def test_words_of_a_command_line() -> None:
    assert LinkFaults.of_texts({"loss": [], "cut": []}) is None
    words = {"loss": ["0.1", "0.2"], "delay": ["0.2..0.4"], "cut": ["1..2", "5..9"], "direction": ["to-client"]}
    expected = LinkFaults(loss=0.2, delay=(0.2, 0.4), cuts=((1.0, 2.0), (5.0, 9.0)), direction="to-client", seed=7)
    assert LinkFaults.of_texts({**words, "seed": ["7"]}) == expected
    assert LinkFaults.of_texts({"delay": ["0.3"], "bandwidth": ["1200"]}) == LinkFaults(delay=0.3, bandwidth=1200.0)


@pytest.mark.parametrize(
    ("name", "word"), [("loss", "much"), ("delay", "0.1..x"), ("cut", "5"), ("seed", "1.5"), ("bandwidth", "")]
)
def test_words_that_cannot_be_understood(name: str, word: str) -> None:
    with pytest.raises(OptionError, match=f"--link-{name} '{word}' is not"):
        LinkFaults.of_texts({name: [word]})


# ---------------------------------------------------------------- with numbers that are no chance


def way(monkeypatch: pytest.MonkeyPatch, faults: LinkFaults, *numbers: float) -> FaultyDirection:
    """One that draws these numbers, 0 .. 1."""
    made, drawn = FaultyDirection(faults), iter(numbers)
    monkeypatch.setattr("sitl.bridge.links.faulty_direction.rng.uniform", lambda generator: next(drawn))
    return made


def arrivals(made: FaultyDirection) -> list[tuple[int, int]]:
    """Times [us] and numbers of the frames that are under way."""
    out = []
    while made.due_us != NEVER:
        due = made.due_us
        out += [(due, number(frame)) for frame in made.arrived(due)]
    return out


@pytest.mark.parametrize(
    ("faults", "numbers", "times"),
    [
        ({"loss": 0.25}, (0.25,), [1_000_000]), ({"loss": 0.25}, (0.2,), []),
        ({"delay": (0.1, 0.3)}, (0.25,), [1_150_000]), ({"delay": (0.1, 0.3)}, (0.0,), [1_100_000]),
        ({"delay": 0.1, "jitter": 0.04}, (0.75,), [1_120_000]), ({"delay": 0.1, "jitter": 0.04}, (0.0,), [1_060_000]),
        ({"delay": 0.1, "jitter": 0.4}, (0.0,), [1_000_000]),
        ({"reordering": 0.5}, (0.25, 0.25), [1_050_000]), ({"reordering": 0.5}, (0.5,), [1_000_000]),
        ({"duplicates": 0.5, "delay": (0.0, 1.0)}, (0.25, 0.5, 0.125), [1_125_000, 1_500_000]),
        ({"duplicates": 0.5, "jitter": 0.1}, (0.25, 0.75, 0.0), [1_000_000, 1_050_000]),
        ({"bandwidth": 7000.0}, (), [1_002_143]), ({"bandwidth": 7000.0, "delay": 0.5}, (), [1_502_143]),
    ],
)  # fmt: skip
def test_when_a_frame_comes(monkeypatch: pytest.MonkeyPatch, faults: Any, numbers: Any, times: list[int]) -> None:
    """One of 15 bytes, sent a second after the start."""
    made = way(monkeypatch, LinkFaults(**faults), *numbers)
    now = made.carry(FRAMES[:1], 1_000_000)
    assert sorted([1_000_000] * len(now) + [due for due, _ in arrivals(made)]) == times


def test_a_frame_that_is_overtaken_holds_up_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    made = way(monkeypatch, LinkFaults(reordering=0.5, delay=(0.0, 1.0)), 0.5, 0.9, 0.2, 0.1, 0.5, 0.3, 0.9)
    made.carry(FRAMES[:2], 0)
    made.carry(FRAMES[2:3], 1000)
    assert arrivals(made) == [(300_000, 1), (500_000, 0), (500_000, 2)]


@pytest.mark.parametrize(("frames", "now_us", "full"), [(2, 50_000, False), (2, 49_999, True), (1, 0, False)])
def test_telemetry_waits_while_a_quarter_of_a_second_of_frames_does(frames: int, now_us: int, full: bool) -> None:
    made = FaultyDirection(LinkFaults(bandwidth=100.0))  # a frame in 150 ms
    made.carry(FRAMES[:frames], 0)
    made.arrived(now_us)
    assert made.is_full == full


@pytest.mark.parametrize(("now_us", "lost"), [(50_000, 0), (49_999, 1)])
def test_frames_wait_for_four_seconds(now_us: int, lost: int) -> None:
    made = FaultyDirection(LinkFaults(bandwidth=100.0))
    made.carry(FRAMES[:27], 0)
    made.carry(FRAMES[27:28], now_us)
    while made.due_us < 4_100_000:
        made.arrived(made.due_us)
    assert len(arrivals(made)) == 1 - lost


def test_bits_are_turned_over_as_far_from_each_other_as_chance_has_it(monkeypatch: pytest.MonkeyPatch) -> None:
    made = way(monkeypatch, LinkFaults(corruption=0.5), 0.75, 0.0, 0.9375, 0.9999, 1.0 - 2.0**-53, 1.0 - 2.0**-53)
    (frame,) = made.carry([bytes(3)], 0)
    assert frame == bytes([0b1100, 0b1, 0b1000000])
    assert made.carry([bytes(3)], 0) == [bytes(3)]


def test_what_is_under_way_or_begun_is_not_idle() -> None:
    made = FaultyDirection(LinkFaults())
    assert made.is_idle and made.due_us == NEVER
    assert made.carry_bytes(FRAMES[0][:5], 0) == [] and not made.is_idle
    assert made.carry_bytes(FRAMES[0][5:], 0) == [FRAMES[0]] and made.is_idle
    made.faults = LinkFaults(delay=0.1)
    made.carry(FRAMES[:1], 0)
    made.faults = LinkFaults()
    assert not made.is_idle and made.due_us == 100_000
    assert made.arrived(99_999) == [] and made.arrived(100_000) == FRAMES[:1] and made.is_idle


@pytest.mark.parametrize("encode", [encode_v1, encode_v2])
def test_clocks_are_pushed_by_two_commands_in_both_versions(encode: Any) -> None:
    for name in ("COMMAND_INT", "COMMAND_ACK"):
        kind = message(name)
        found = [n for n in (31009, 31010, 31011, 31012) if is_of_clock(encode(kind, kind.payload(command=n), 0, 1, 1))]
        assert found == [31010, 31011]
        frame = encode(kind, kind.payload(command=31010), 0, 1, 1)
        at = frame.index(b"\x22\x79")
        assert is_of_clock(frame[: at + 2]) and not is_of_clock(frame[: at + 1])
    kind = message("COMMAND_LONG")
    assert not is_of_clock(encode(kind, kind.payload(command=31010), 0, 1, 1))
