# SPDX-License-Identifier: BSD-3-Clause
"""Snapshots and forks leave no trace, and a flight that is flown again is the same to the bit."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.missions.testing import factory
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.logs import fly_again, keep
from sitl.missions.testing.vehicle import Copter
from sitl.recording.entries import of_state
from sitl.recording.recording import read


def fly(copter: Copter) -> None:
    copter.takeoff(8)
    copter.set_velocity(2, 1)
    copter.delay(3.3)
    copter.set_rc(roll=1600)


def test_a_fork_leaves_no_trace(make: VehicleFactory, tmp_path: Path) -> None:
    one, other = make("copter"), make("copter")
    fly(one)
    fly(other)
    with other.fork():
        other.fail("motor")
        other.land()
    assert (one.describe(), one.texts, one.now) == (other.describe(), other.texts, other.now)
    for copter in (one, other):
        copter.fly_to(5, 5, 10)
        copter.wait_location(5, 5, 10, hold=1)
    assert of_state(one.simulation) == of_state(other.simulation)
    assert one.script.said == other.script.said
    assert fly_again(other, tmp_path, "flight", log=False).same


def test_a_moment_can_be_gone_back_to_twice(make: VehicleFactory) -> None:
    copter = make("copter")
    copter.takeoff(5)
    moment = copter.snapshot()
    ends = set()
    for _ in range(2):
        copter.fly_to(10, 0)
        ends.add((of_state(copter.simulation), copter.now))
        copter.restore(moment)
    assert len(ends) == 1


def test_a_vehicle_from_a_boot_that_was_kept_is_like_one_that_booted(make: VehicleFactory) -> None:
    first = make("copter", seed=123)
    again = make("copter", seed=123)
    booted = make("copter", seed=123, ready=False)
    booted.wait_ready()
    for copter in (first, again, booted):
        fly(copter)
    assert len({of_state(copter.simulation) for copter in (first, again, booted)}) == 1
    assert len({tuple(copter.script.said) for copter in (first, again, booted)}) == 1


def test_boots_are_kept_in_numbers(make: VehicleFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(factory, "KEPT", 2)
    monkeypatch.setattr(factory, "_kept", type(factory._kept)())
    for seed in (1, 2, 3):
        make("rover", seed=seed)
    assert [setup.seed for setup, _ in factory._kept] == [2, 3]


def test_what_comes_before_is_flown_once(make: VehicleFactory, tmp_path: Path) -> None:
    flown = []

    def in_the_air(copter: Copter) -> None:
        flown.append(copter)
        copter.takeoff(12)

    first, again = make("copter", after=in_the_air), make("copter", after=in_the_air)
    assert flown == [first]
    assert again.height == first.height > 11 and again.texts == first.texts
    again.set_position(5, 5)
    again.delay(2)
    assert fly_again(again, tmp_path, "flight", log=False).same


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_a_flight_that_is_flown_again_is_the_same(make: VehicleFactory, tmp_path: Path, kind: str) -> None:
    vehicle = make(kind, wind=(3, 90, 0.5))
    vehicle.change_mode("GUIDED")
    vehicle.arm()
    vehicle.set_velocity(1, 0.5)
    vehicle.delay(10.0025)
    flown = fly_again(vehicle, tmp_path, "flight", log=True)
    assert flown.same
    assert [file.name for file in flown.files] == ["flight.tlog", "flight.bin", "flight.rec"]
    assert read(tmp_path / "flight.rec").end_us == vehicle.simulation.time_us


def test_reaching_past_mavlink_is_noticed(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter")
    copter.simulation.v.physics.body.vel = copter.simulation.v.physics.body.vel.replace(x=1.0)
    copter.delay(1)
    assert not fly_again(copter, tmp_path, "flight", log=False).same
    with pytest.raises(AssertionError, match="past MAVLink"):
        copter.save_recording(tmp_path / "flight.rec")


def test_the_logs_of_a_fork_that_failed_are_of_the_fork(make: VehicleFactory, tmp_path: Path) -> None:
    copter = make("copter")
    copter.takeoff(5)
    before = copter.simulation.time_us
    with pytest.raises(AssertionError) as failure, copter.fork():
        copter.wait_altitude(100, timeout=20)
    assert copter.simulation.time_us == before
    lines = keep(copter, tmp_path, "copter", failure.value)
    assert "the flight is the one that failed in its fork" in lines
    assert read(tmp_path / "copter.rec").end_us == before + 20_000_000
