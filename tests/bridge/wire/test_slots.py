# SPDX-License-Identifier: BSD-3-Clause
"""How far each vehicle of a fleet goes on in the core, and what it leaves to its shell; here as plain Python."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.bridge.wire import fleet
from sitl.bridge.wire.fleet import GOES_ON, STAYS, TO_HEAR, TO_SERVE


def test_what_is_left_to_the_shell_is_told_apart() -> None:
    assert len({GOES_ON, TO_HEAR, TO_SERVE}) == 3 and GOES_ON == 0 and STAYS < 0


class Bench:
    """A vehicle whose clients' words and streams are the test's."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, ports: Any = (), due_us: int = 10**9) -> None:
        self.v = SimpleNamespace(time_us=1000, autopilot=SimpleNamespace(events=SimpleNamespace(count=5)))
        self.ports = [SimpleNamespace(in_size=size, frame_end=0) for size in ports]
        self.wants_shell = self.stops = self.happens = False
        self.heard: list[int] = []
        self.ran: list[tuple[int, int]] = []
        self.falls_short_us = 0
        self.slots = [SimpleNamespace(until_us=2000, shell_us=5000, events_seen=5, needs_shell=9, ports=0,
                                      clients=len(self.ports)) for _ in range(3)]  # fmt: skip
        monkeypatch.setattr(fleet, "SIZE", 1)
        monkeypatch.setattr(fleet, "SLOT_SIZE", 1)
        monkeypatch.setattr(fleet, "record_at", lambda kind, at: (self.slots if kind is fleet.Slot else self.ports)[at])
        monkeypatch.setattr(fleet, "wants_shell", lambda v, ranging: self.wants_shell)
        monkeypatch.setattr(fleet, "next_due", lambda at, clients: due_us)

    def receive(self, vehicles: Any, index: int, port: int) -> None:
        self.heard.append(port)
        if self.stops:
            self.ports[port].frame_end = 12
        if self.happens:
            self.v.autopilot.events.count += 1

    def run(self, vehicles: Any, index: int, ports: int, clients: int, ranging: int, zero: int, until: int,
            shell: int) -> None:  # fmt: skip
        self.ran.append((until, shell))
        self.v.time_us = until - self.falls_short_us

    def go(self, **slot: int) -> int:
        vars(self.slots[0]).update(slot)
        fleet.run_slot([self.v], 0, 0, self.slots[0], self.receive, self.run)  # type: ignore[arg-type]
        return int(self.slots[0].needs_shell)


def test_a_vehicle_goes_on_to_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch, ports=(0, 3, 0))
    assert bench.go() == GOES_ON and bench.ran == [(2000, 5000)] and bench.heard == [1], "who said something is heard"


@pytest.mark.parametrize(
    ("until", "shell", "ran"),
    [(2000, 5000, (2000, 5000)), (5001, 5000, (5000, 5000)), (5000, 5000, (5000, 5000)), (4999, 5000, (4999, 5000))],
)
def test_it_stops_where_the_shell_has_something_to_do(
    until: int, shell: int, ran: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench(monkeypatch)
    needs = bench.go(until_us=until, shell_us=shell)
    assert bench.ran == [ran] and needs == (GOES_ON if until < shell else TO_SERVE)


@pytest.mark.parametrize("until", [1000, 999])
def test_one_that_is_there_does_nothing(until: int, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    assert bench.go(until_us=until) == GOES_ON and bench.ran == []


@pytest.mark.parametrize("why", ["stops", "happens", "wants_shell"])
def test_words_that_are_the_shells_stop_it_before_it_goes_on(why: str, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch, ports=(3, 3))
    setattr(bench, why, True)
    assert bench.go() == TO_HEAR and bench.ran == []
    assert bench.heard == ([0, 1] if why == "wants_shell" else [0]), "the others wait"


def test_an_event_that_the_shell_has_not_seen_stops_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert Bench(monkeypatch).go(events_seen=4) == TO_HEAR


@pytest.mark.parametrize("why", ["event", "short", "wants", "due"])
def test_what_happens_on_the_way_is_served(why: str, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch, due_us=2000 if why == "due" else 2001)
    bench.falls_short_us = int(why == "short")
    plain = bench.run

    def run(*given: Any) -> None:
        plain(*given)
        bench.v.autopilot.events.count += why == "event"
        bench.wants_shell = why == "wants"

    bench.run = run  # type: ignore[method-assign]
    assert bench.go() == TO_SERVE


def test_those_that_stay_are_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    bench.slots[0].until_us = STAYS
    bench.slots[2].until_us = 3000
    fleet.run_slots([bench.v] * 3, 0, 3, 0, 0, bench.receive, bench.run)  # type: ignore[arg-type, list-item]
    assert [slot.needs_shell for slot in bench.slots] == [GOES_ON] * 3
    assert [until for until, _ in bench.ran] == [2000, 3000]
    bench.ran.clear()
    bench.slots[1].until_us = bench.slots[2].until_us = 4000
    fleet.run_slots([bench.v] * 3, 1, 2, 0, 0, bench.receive, bench.run)  # type: ignore[arg-type, list-item]
    assert [until for until, _ in bench.ran] == [4000], "of those that were asked for"


def test_goals_and_who_waits() -> None:
    until = np.zeros(3, np.int64)
    fleet.set_goals(np.array([10, 20, 30]), until, 5)
    assert until.tolist() == [15, 25, 35]
    for needs, waits in (([0, 0, 0], False), ([0, 0, 2], True), ([1, 0, 0], True), ([], False)):
        assert fleet.any_waits(np.array(needs, np.int64)) == waits


@pytest.mark.parametrize(("step", "untils"), [(STAYS, [2000] * 3), (500, [1500, 2500, 3500])])
def test_a_whole_fleet_goes_on(step: int, untils: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    times = {100: 1000, 108: 2000, 116: 3000}
    asked: list[Any] = []
    monkeypatch.setattr(fleet, "ints_at", lambda at, count: [times[at]] * count)
    monkeypatch.setattr(fleet, "call_unit", lambda *given: asked.append(given))
    for slot in bench.slots:
        slot.needs_shell = GOES_ON
    assert not fleet.run_fleet(77, 100, 8, 3, 0, 55, step)
    assert asked == [(77, 100, 3, 0, 3, 0, 55)] and [slot.until_us for slot in bench.slots] == untils
    bench.slots[2].needs_shell = TO_HEAR
    assert fleet.run_fleet(77, 100, 8, 3, 0, 55, STAYS)
