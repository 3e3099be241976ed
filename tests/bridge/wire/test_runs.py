# SPDX-License-Identifier: BSD-3-Clause
"""How a vehicle goes on in the core from one due time to the next, and how frames are spooled; here as plain Python."""

from __future__ import annotations

import struct
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.channel import Channel, Ports
from sitl.bridge.links.inprocess import InProcessLink
from sitl.bridge.wire import link
from sitl.bridge.wire.link import REGULAR, Instruments, Limits, Links, run_vehicle, transmit_links
from sitl.bridge.wire.spool import FRAMES, SPOOL_BYTES, spill_all
from sitl.core.constants import NEVER

RANGING, SAMPLER = 3000, 4000


class Bench:
    """A vehicle of which the test says what is due when; ``done`` holds what was done, and at which time."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.v: Any = SimpleNamespace(
            time_us=10_000, autopilot=SimpleNamespace(events=SimpleNamespace(count=5, attention=False)),
            physics=SimpleNamespace(obstacles=SimpleNamespace(wanted=False)),
        )  # fmt: skip
        self.messages_us = self.rows_us = self.scans_us = NEVER
        self.every_us = 5000
        self.has_space = self.has_rows = self.core_sends = True
        self.done: list[tuple[Any, ...]] = []
        self.happens_us = NEVER
        for name, value in {
            "list_near": self.list_near, "measure": self.measure, "take_row": self.take_row, "spill_all": self.spill,
            "measurement_due": lambda v, ranging: self.scans_us if ranging == RANGING else NEVER,
            "row_due": lambda sampler: self.rows_us if sampler == SAMPLER else NEVER,
            "next_due": lambda address, count: self.messages_us if (address, count) == (500, 2) else NEVER,
        }.items():  # fmt: skip
            monkeypatch.setattr(link, name, value)

    def note(self, what: str, *more: Any) -> None:
        self.done.append((what, self.v.time_us, *more))

    def list_near(self, fleet: Any, index: int, ranging: int) -> None:
        self.note("list")
        self.v.physics.obstacles.wanted = False

    def advance(self, fleet: Any, index: int, ticks: int) -> None:
        self.note("go", ticks)
        self.v.time_us += 2500 * ticks
        if self.v.time_us >= self.happens_us:
            self.v.autopilot.events.count += 1

    def measure(self, fleet: Any, index: int, ranging: int) -> None:
        self.note("measure")
        self.scans_us += 20_000

    def transmit(self, fleet: Any, index: int, address: int, clients: int, number: int) -> None:
        self.note("send", address, clients, number)
        if self.core_sends:
            self.messages_us = (self.v.time_us // self.every_us + 1) * self.every_us

    def spill(self, address: int, count: int, now_us: int) -> bool:
        self.note("spill", now_us)
        return self.has_space

    def take_row(self, address: int, now_us: int) -> bool:
        self.note("row", now_us)
        self.rows_us += 10_000
        return self.has_rows

    def run(self, until_us: int, shell_us: int = NEVER) -> list[tuple[str, int]]:
        self.done.clear()
        instruments = Instruments(RANGING, SAMPLER)
        limits, transmit = Limits(until_us, shell_us), self.transmit
        run_vehicle([None, self.v], 1, Links(500, 2), instruments, limits, self.advance, transmit)
        return [entry[:2] for entry in self.done]


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(monkeypatch)


@pytest.mark.parametrize(
    ("until_us", "ticks"), [(9_000, 1), (10_000, 1), (12_500, 1), (12_501, 2), (15_000, 2), (15_001, 3)]
)
def test_a_vehicle_goes_on_to_the_first_tick_at_or_after_its_time(bench: Bench, until_us: int, ticks: int) -> None:
    assert bench.run(until_us) == [("go", 10_000)] and bench.done[0][2] == ticks


def test_what_falls_due_on_the_way_is_done_in_its_order(bench: Bench) -> None:
    """First it measures, then messages tell of it, then a row is logged."""
    bench.messages_us, bench.rows_us, bench.scans_us = 15_000, 20_000, 20_000
    assert bench.run(25_000) == [
        ("go", 10_000), ("send", 15_000), ("spill", 15_000), ("go", 15_000),
        ("measure", 20_000), ("send", 20_000), ("spill", 20_000), ("row", 20_000), ("go", 20_000),
        ("send", 25_000), ("spill", 25_000),
    ]  # fmt: skip
    assert bench.done[1][2:] == (500, 2, REGULAR) and bench.done[2][2:] == (15_000,)


@pytest.mark.parametrize(
    ("change", "last"),
    [
        ({}, ("spill", 30_000)),
        ({"has_space": False}, ("spill", 15_000)),
        ({"core_sends": False}, ("spill", 15_000)),
        ({"happens_us": 12_500, "messages_us": NEVER, "rows_us": 12_500}, ("go", 10_000)),
        ({"rows_us": 12_500, "has_rows": False}, ("row", 12_500)),
        ({"rows_us": 15_000, "has_space": False}, ("row", 15_000)),
    ],
)
def test_it_comes_back_early_for_the_shell(bench: Bench, change: dict[str, Any], last: Any) -> None:
    """For events, for messages that are the shell's, and where what is sent or logged needs space."""
    bench.messages_us = 15_000
    vars(bench).update(change)
    assert bench.run(30_000)[-1] == last


@pytest.mark.parametrize(("shell_us", "sends"), [(15_000, False), (15_001, True)])
def test_the_shell_acts_before_messages_are_sent(bench: Bench, shell_us: int, sends: bool) -> None:
    bench.messages_us = 15_000
    assert (("send", 15_000) in bench.run(15_000, shell_us)) == sends


@pytest.mark.parametrize(("wanted", "ranging", "wants"), [(True, 9, False), (True, 0, True), (False, 9, True)])
def test_solids_are_listed_without_the_shell(bench: Bench, wanted: bool, ranging: int, wants: bool) -> None:
    bench.v.physics.obstacles.wanted, bench.v.autopilot.events.attention = wanted, True
    assert link.wants_shell(bench.v, ranging) == wants
    bench.v.autopilot.events.attention = False
    assert not link.wants_shell(bench.v, ranging)


def test_a_vehicle_that_wants_another_list_of_solids_goes_on(bench: Bench) -> None:
    bench.v.physics.obstacles.wanted = bench.v.autopilot.events.attention = True
    assert bench.run(15_000) == [("list", 10_000), ("go", 10_000)] and not bench.v.autopilot.events.attention
    bench.v.autopilot.events.attention = True
    bench.messages_us = 20_000
    assert bench.run(30_000) == [("go", 15_000)], "and comes back where the shell is wanted for something else"


def test_one_message_is_for_the_first_client(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[tuple[Any, ...]] = []
    monkeypatch.setattr(link, "send_all_due", lambda *a: calls.append(("all", *a)))
    monkeypatch.setattr(link, "send", lambda *a: calls.append(("one", *a)))
    monkeypatch.setattr(link, "record_at", lambda kind, address: address)
    v: Any = "vehicle"
    build: Any = "builder"
    transmit_links(v, Links(500, 2), REGULAR, build)
    transmit_links(v, Links(500, 2), 30, build)
    assert calls == [("all", v, 500, 2, build), ("one", v, 500, 500, 30, build)]


# ---------------------------------------------------------------------- spools


def spooling(stamped: bool) -> tuple[Ports, list[Channel]]:
    """A client without a spool and one with."""
    channels = []
    for k in range(2):
        peer = InProcessLink().peers[0]
        peer.spools, peer.stamps = k == 1, stamped
        channels.append(Channel(peer, k, 1, lambda: True))
    ports = Ports()
    ports.arrange(channels)
    channels[1].port.spool = channels[1].spool_address
    channels[1].port.epoch_us = 0x0102030405000000
    return ports, channels


def filled(channel: Channel, *made: bytes) -> None:
    """Frames as the core leaves them in a port."""
    port, data = channel.port, b"".join(made)
    at = port.fields["out"].offset
    port._bytes[at : at + len(data)] = data
    for k in range(len(made)):
        port.out_end[k] = sum(map(len, made[: k + 1]))
    port.out_count, port.out_size = len(made), len(data)


@pytest.mark.parametrize("stamped", [False, True])
def test_frames_of_several_times_lie_one_behind_the_other(stamped: bool) -> None:
    """A log's each behind its Unix time, most significant byte first."""
    ports, (plain, spooled) = spooling(stamped)
    assert spooled.spool is not None
    expected = b""
    for now_us, made in ((0x60708, (b"one", b"fourth")), (0x6070A, ()), (0x6070B, (b"x",))):
        filled(plain, b"here")
        filled(spooled, *made)
        assert spill_all(ports.address, 2, now_us)
        expected += b"".join((struct.pack(">Q", 0x0102030405000000 + now_us) if stamped else b"") + m for m in made)
        assert (spooled.port.out_count, spooled.port.out_size) == (0, 0)
        assert (plain.port.out_count, plain.port.out_size) == (1, 4), "those of others stay"
    assert bytes(spooled.spool._bytes[FRAMES : FRAMES + spooled.spool.used]) == expected
    taken: list[bytes] = []
    spooled.peer.spooled = taken.append  # type: ignore[method-assign]
    spooled.collect()
    assert taken == [expected] and not spooled.has_spooled()


@pytest.mark.parametrize(("used", "has_space"), [(58_112, True), (58_113, False), (SPOOL_BYTES, False)])
def test_a_spool_that_is_nearly_full_has_to_be_emptied(used: int, has_space: bool) -> None:
    """What a port holds, 6144 bytes and 160 times, has to fit."""
    ports, (_, spooled) = spooling(True)
    assert spooled.spool is not None
    spooled.spool.used = used
    assert spill_all(ports.address, 2, 0) == has_space
