# SPDX-License-Identifier: BSD-3-Clause
"""The client in the vehicle's process: what a user writes, and what it says when the vehicle does not do it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from sitl import Simulation
from sitl.client import (
    Client,
    CommandRefusedError,
    InvariantError,
    MissionRefusedError,
    Moment,
    ParameterRefusedError,
    UnknownNameError,
    WaitTimeoutError,
)
from sitl.recording.entries import of_state
from sitl.simulation import Core


@pytest.fixture(scope="module")
def booted(core: Core) -> Moment:
    vehicle = Client(Simulation("erle_copter", seed=1, core=core))
    vehicle.wait_ready()
    return vehicle.snapshot()


@pytest.fixture
def copter(core: Core, booted: Moment) -> Iterator[Client]:
    vehicle = Client(Simulation("erle_copter", seed=1, core=core), name="copter")
    vehicle.restore(booted)
    yield vehicle
    vehicle.close()


def test_a_flight(copter: Client) -> None:
    copter.take_off(10)
    copter.goto(north=20, east=5, altitude=12)
    assert copter.position == pytest.approx((20, 5, 12), abs=1.1)
    assert copter.mode == "GUIDED" and copter.armed
    assert all(abs(angle) < 0.5 for angle in copter.attitude[:2])
    copter.wait(lambda t: t.groundspeed < 0.3, timeout=10)
    copter.set_velocity(0, 2)
    copter.delay(5)
    assert copter.velocity[1] == pytest.approx(2, abs=0.3)
    copter.land()
    assert copter.altitude < 0.5
    copter.wait_landed(timeout=1)


def test_time_passes_only_in_calls_that_wait(copter: Client) -> None:
    began = copter.now
    copter.send_command("DO_SET_MODE", 1, 4)
    copter.set_position(5, 5)
    assert copter.now == began
    copter.delay(0.25)
    assert copter.now == pytest.approx(began + 0.25)


def test_commands_have_names_and_named_parameters(copter: Client) -> None:
    copter.command("COMPONENT_ARM_DISARM", arm=1)
    assert copter.request("MAV_CMD_COMPONENT_ARM_DISARM", arm=0) == 0
    copter.command("DO_SET_MODE", mode="MAV_MODE_FLAG_CUSTOM_MODE_ENABLED", custom_mode=5)
    copter.wait_mode("LOITER", timeout=1)
    with pytest.raises(UnknownNameError, match=r"no command 'NAV_TAKE_OFF'; did you mean 'NAV_TAKEOFF'\?"):
        copter.command("NAV_TAKE_OFF", altitude=5)
    with pytest.raises(UnknownNameError, match=r"NAV_TAKEOFF has no parameter 'height'; it has .*altitude"):
        copter.command("NAV_TAKEOFF", height=5)
    with pytest.raises(UnknownNameError, match=r"no constant 'MAV_FRAME_MOON'"):
        copter.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame="MAV_FRAME_MOON")


def test_a_refused_command_says_why(core: Core) -> None:
    copter = Client(Simulation("erle_copter", core=core), name="cold")
    copter.delay(3)
    with pytest.raises(CommandRefusedError) as failure:
        copter.arm()
    error = failure.value
    assert (error.subject, error.result, error.result_name) == ("arming", 4, "failed")
    assert any(text.startswith("Arm: ") for text in error.texts)
    assert "arming was refused: failed\n  cold at 3.1 s simulated: STABILIZE, disarmed" in str(error)


def test_a_wait_in_vain_says_what_was_seen(copter: Client) -> None:
    copter.arm()
    began = copter.now
    with pytest.raises(WaitTimeoutError, match=r"waited 2 s for an altitude of at least 5 m\n  last seen: ") as failure:
        copter.wait_altitude(5, timeout=2)
    assert copter.now == pytest.approx(began + 2)
    assert isinstance(failure.value, TimeoutError) and failure.value.seconds == 2


def test_what_must_hold_at_all_times(copter: Client) -> None:
    copter.take_off(3)
    with (
        pytest.raises(InvariantError, match="stays low; it is not so now"),
        copter.always(lambda: copter.altitude < 5, "stays low"),
    ):
        copter.goto(0, 0, 8)


def test_parameters(copter: Client) -> None:
    before = copter.params["WPNAV_SPEED"]
    copter.params["WPNAV_SPEED"] = 321
    assert copter.params["WPNAV_SPEED"] == 321
    with copter.params.changed(WPNAV_SPEED=400, RTL_ALT=2000):
        assert copter.params["RTL_ALT"] == 2000
    assert copter.params["WPNAV_SPEED"] == 321 != before
    with pytest.raises(ParameterRefusedError, match="ANGLE_MAX was not set to 99999"):
        copter.params["ANGLE_MAX"] = 99999
    with pytest.raises(UnknownNameError, match="no parameter 'WPNAV_SPED'; near to it: WPNAV_SPEED"):
        copter.params["WPNAV_SPED"] = 1
    everything = copter.params.read_all()
    assert (
        set(everything) == {p.name for p in copter.simulation.parameters.listed()} and everything["WPNAV_SPEED"] == 321
    )


def test_a_mission(copter: Client) -> None:
    way = [copter.item("NAV_WAYPOINT", north, east, altitude=8) for north, east in ((15, 0), (15, 15))]
    copter.upload([
        copter.item("NAV_WAYPOINT"), copter.item("NAV_TAKEOFF", altitude=8), *way, copter.item("NAV_RETURN_TO_LAUNCH")
    ])  # fmt: skip
    copter.start_mission()
    copter.wait_waypoint(3)
    assert math.dist(copter.position[:2], (15, 15)) < 3
    copter.wait_disarmed()
    assert copter.reached == [1, 2, 3, 4]


def test_a_mission_that_is_refused(copter: Client) -> None:
    with pytest.raises(MissionRefusedError, match="the mission was refused: unsupported command") as failure:
        copter.upload([copter.item("NAV_WAYPOINT"), copter.item("NAV_FENCE_RETURN_POINT")])
    assert failure.value.result == 3


def test_sticks(copter: Client) -> None:
    copter.rc(throttle=1000, roll=1700)
    copter.delay(0.5)
    assert copter.message("RC_CHANNELS").chan1_raw == 1700
    copter.release_rc()
    copter.delay(0.5)
    assert copter.message("RC_CHANNELS").chan1_raw == 1500


def test_other_futures(copter: Client) -> None:
    copter.take_off(5)
    moment, before = copter.snapshot(), copter.describe()
    ends = set()
    for _ in range(2):
        copter.goto(8, 0)
        ends.add((of_state(copter.simulation), copter.now))
        copter.restore(moment)
    assert len(ends) == 1
    with copter.fork():
        copter.land()
    assert copter.describe() == before


def test_a_reboot(copter: Client) -> None:
    copter.reboot()
    with copter.messages("ATTITUDE") as attitudes:
        copter.delay(3)
    assert len(attitudes) > 25, "telemetry is asked for again"
    copter.wait_ready()
    copter.take_off(3)


def test_a_rover(core: Core) -> None:
    rover = Client(Simulation("erle_rover"))
    rover.wait_ready()
    rover.guided_and_armed()
    rover.goto(8, 3)
    rover.set_mode("HOLD")
    rover.wait_groundspeed(-math.inf, 0.1, hold=1)
    assert math.dist(rover.position[:2], (8, 3)) < 2
    rover.close()
