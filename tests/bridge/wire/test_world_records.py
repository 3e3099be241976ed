# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles of a fleet that are in different worlds, run one by one in a thread; here as plain Python."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.wire import world_records
from sitl.bridge.wire.fleet import GOES_ON, SLOT_SIZE, STAYS, TO_HEAR, TO_SERVE
from sitl.bridge.wire.world_records import Vehicles, run_in_worlds

UNIT, RECORDS, SIZE, TOTAL = 7, 100_000, 1000, 4
SLOTS, RANGING, RANGING_SIZE = 500_000, 900_000, 64
VEHICLES = Vehicles(UNIT, RECORDS, SIZE, TOTAL)


class Bench:
    """Four vehicles, each 10 us later than the one before, and what becomes of each where it is run."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, needs: Any = (GOES_ON,) * TOTAL) -> None:
        self.slots = [SimpleNamespace(until_us=-5, needs_shell=GOES_ON) for _ in range(TOTAL)]
        self.ran: list[tuple[int, ...]] = []
        self.needs = needs
        times = {RECORDS + k * SIZE: [1000 + 10 * k] for k in range(TOTAL)}
        addresses = {SLOTS + k * SLOT_SIZE: slot for k, slot in enumerate(self.slots)}
        monkeypatch.setattr(world_records, "ints_at", lambda address, count: times[address][:count])
        monkeypatch.setattr(world_records, "record_at", lambda kind, address: addresses[address])
        monkeypatch.setattr(world_records, "call_unit", self.call)

    def call(self, *arguments: int) -> None:
        self.ran.append(arguments)
        self.slots[arguments[3]].needs_shell = self.needs[arguments[3]]

    def go(self, first: int = 0, count: int = TOTAL, step_us: int = 2500) -> bool:
        return run_in_worlds(VEHICLES, first, count, SLOTS, RANGING, RANGING_SIZE, step_us)

    @property
    def until(self) -> list[int]:
        return [slot.until_us for slot in self.slots]


@pytest.mark.parametrize(
    ("needs", "waits"),
    [
        ((GOES_ON, GOES_ON, GOES_ON, GOES_ON), False),
        ((TO_HEAR, GOES_ON, GOES_ON, GOES_ON), True),
        ((GOES_ON, TO_SERVE, GOES_ON, GOES_ON), True),
        ((GOES_ON, GOES_ON, GOES_ON, TO_HEAR), True),
        ((TO_SERVE, TO_HEAR, TO_SERVE, TO_HEAR), True),
    ],
)
def test_one_that_needs_the_shell_is_told_and_the_others_go_on(
    needs: Any, waits: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench(monkeypatch, needs)
    assert bench.go() is waits
    assert len(bench.ran) == TOTAL


def test_who_is_of_another_thread_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    bench.slots[0].needs_shell = bench.slots[3].needs_shell = TO_HEAR
    assert bench.go(1, 2) is False and [ran[3] for ran in bench.ran] == [1, 2]
    assert bench.go(0, 0) is False


def test_each_runs_alone_with_a_record_of_its_own_for_ranging(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    bench.go(1, 2)
    assert bench.ran == [(UNIT, RECORDS, TOTAL, k, k + 1, SLOTS, RANGING + k * RANGING_SIZE) for k in (1, 2)]


def test_a_step_goes_from_each_ones_own_time(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    bench.go(1, 3, 2500)
    assert bench.until == [-5, 3510, 3520, 3530]
    bench.go(0, 1, 0)
    assert bench.until == [1000, 3510, 3520, 3530]


def test_without_a_step_the_slots_say_how_far(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(monkeypatch)
    bench.slots[2].until_us = STAYS
    bench.go(step_us=STAYS)
    assert bench.until == [-5, -5, STAYS, -5] and len(bench.ran) == TOTAL
