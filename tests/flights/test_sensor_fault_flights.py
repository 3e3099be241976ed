# SPDX-License-Identifier: BSD-3-Clause
"""IMUs and compasses fail in the air. "The real one" is ArduPilot 4.7 in its own simulator, hovering in LOITER."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from sitl.autopilot.vibration import vibration_levels
from sitl.core.algebra import euler_of
from sitl.core.scalars import wrap_pi
from sitl.simulation import Core
from tests.flights.aviator import GUIDED, LAND, LOITER, Aviator

SECOND_LANE, PRIMARY = "EKF3 lane switch 1", "EKF primary changed:1"


def loiter(core: Core, **params: float) -> Aviator:
    """In LOITER, at 15 m."""
    p = Aviator(core, "ardupilot_quad", **params).hover(15.0)
    p.sticks(2.0)
    assert p.set_mode(LOITER)
    p.sticks(3.0)
    return p


def fail(p: Aviator, **faults: float) -> float:
    """Set SIM_ parameters; the time [s]."""
    for name, value in faults.items():
        p.set_parameter(f"SIM_{name}", value)
    return p.now


def seconds_until(p: Aviator, text: str, start: float) -> float:
    """When a text was said, after ``start`` [s]."""
    times = [time for time, _, said in p.texts if said == text and time >= start - 0.1]
    assert times, f"{text!r} is not among {p.texts}"
    return times[0] - start


@pytest.mark.parametrize(
    ("fault", "latest", "farthest"),
    [  # by when the other lane is flown by [s], and how far it went meanwhile [m]; beside them the real one's
        ({"GYR1_BIAS_X": 0.2}, 3.0, 5.0),  # 1.8 s, 2.6 m
        ({"GYR1_BIAS_X": 1.0}, 1.5, 8.0),  # 0.8 s, 3.7 m
        ({"ACC1_BIAS_X": 5.0}, 1.0, 6.0),  # 0.6 s, 4.2 m
        ({"ACC1_BIAS_Z": 3.0}, 1.2, 5.0),  # 0.8 s, 2.6 m
        ({"ACCEL1_FAIL": 20.0}, 0.6, 20.0),  # 0.2 s, 8.1 m
    ],
)
def test_a_broken_imu_is_left_for_the_other_one(core: Core, fault: dict[str, float], latest: float, farthest: float):
    p = loiter(core)
    before = p.pos
    start = fail(p, **fault)
    p.sticks(12.0)
    assert seconds_until(p, SECOND_LANE, start) < latest
    assert seconds_until(p, PRIMARY, start) < latest
    assert p.ap.ekf.imu == 1 and p.ap.second_lane.ekf.imu == 0
    assert np.abs(p.since(start)[:, 1:4] - before).max() < farthest
    assert np.linalg.norm(p.vel) < 0.3, "it holds its place again"
    assert p.mode == LOITER
    assert p.ap.estimate.status_flags & 0x3F == 0x3F


@pytest.mark.parametrize("fault", [{"ACC2_BIAS_X": 5.0}, {"GYR2_BIAS_X": 0.2}, {"ACCEL2_FAIL": 20.0}])
def test_a_broken_second_imu_changes_nothing(core: Core, fault: dict[str, float]) -> None:
    p = loiter(core)
    start = fail(p, **fault)
    before = p.pos
    p.sticks(10.0)
    assert not p.said("lane switch")
    assert p.ap.second_lane.runs == 1
    assert np.abs(p.since(start)[:, 1:4] - before).max() < 0.5


def test_without_a_difference_there_is_one_filter_and_it_becomes_one_again(core: Core) -> None:
    p = loiter(core, SIM_ACC1_BIAS_Z=0.3, SIM_ACC2_BIAS_Z=0.3)
    assert p.ap.second_lane.runs == 0, "both are as wrong"
    fail(p, ACC2_BIAS_Z=0.0)
    p.sticks(1.0)
    assert p.ap.second_lane.runs == 1
    fail(p, ACC2_BIAS_Z=0.3)
    p.sticks(62.0)
    assert p.ap.second_lane.runs == 0


@pytest.mark.parametrize(("mask", "bit"), [("GYR_FAIL_MSK", 0x1), ("ACC_FAIL_MSK", 0x2)])
def test_a_silent_sensor_is_replaced_by_the_other_imu_s(core: Core, mask: str, bit: int) -> None:
    """The real one goes on at its place, too, without a lane switch; SYS_STATUS shows the sensor as unhealthy."""
    p = loiter(core)
    before = p.pos
    start = fail(p, **{mask: 1})
    p.sticks(10.0)
    assert np.abs(p.since(start)[:, 1:4] - before).max() < 0.5
    assert p.said("lane switch") is False
    health = p.message("SYS_STATUS").onboard_control_sensors_health
    assert health & 0x3 == 0x3 & ~bit


def test_rotors_shake_the_imus(core: Core) -> None:
    """With an amplitude of 1 m/s^2 and 100 turns a second; the real one's levels are 0.8 to 1.1. It flies on.

    Four rotors beat: a level by itself is 1.0 to 1.7.
    """
    p = loiter(core, SIM_ACC1_RND=0.5, SIM_ACC2_RND=0.5, SIM_VIB_MOT_MULT=2.0)
    found: dict[float, list[float]] = {0.0: [], 100.0: []}
    for hz in (0.0, *[100.0] * 6):
        p.set_parameter("SIM_VIB_MOT_MAX", hz)
        p.sticks(4.0)
        found[hz].append(vibration_levels(p.ap.vibration).z)
    assert max(found[0.0]) < 0.1 and sum(found[100.0]) / 6 == approx(2.0 * math.sqrt(0.5), abs=0.3)
    assert abs(p.height - 15.0) < 0.5 and p.mode == LOITER
    assert p.ap.ekf.imu == 0


def test_both_accelerometers_wrong_is_vibration_s_failsafe(core: Core) -> None:
    """The real one: "Vibration compensation ON" after 2.9 s, "EKF variance" and LAND after 3.7 s."""
    p = loiter(core)
    start = fail(p, ACC1_BIAS_Z=2.0, ACC2_BIAS_Z=2.0)
    p.sticks(10.0)
    assert seconds_until(p, "Vibration compensation ON", start) < 6.0
    assert p.mode in (LOITER, LAND)
    assert p.height > 5.0


def test_compasses_that_fall_silent_are_left_one_after_the_other(core: Core) -> None:
    """The real one switches 10.1 s after each failure; after all were silent, at once when one of them comes back."""
    p = loiter(core)
    before = p.euler[2]
    for k, (failed, taken) in enumerate(((1, 1), (2, 2))):
        start = fail(p, **{f"MAG{failed}_FAIL": 1})
        p.sticks(12.0)
        for imu in (0, 1):
            wait = seconds_until(p, f"EKF3 IMU{imu} switching to compass {taken}", start)
            assert 9.8 < wait < 10.3, k
        assert p.message("SYS_STATUS").onboard_control_sensors_health & 0x4 == 0, "of the first compass"
    fail(p, MAG3_FAIL=1)
    p.sticks(12.0)
    start = fail(p, MAG1_FAIL=0)
    p.sticks(2.0)
    assert seconds_until(p, "EKF3 IMU0 switching to compass 0", start) < 0.2
    assert p.message("SYS_STATUS").onboard_control_sensors_health & 0x4 != 0
    assert abs(p.euler[2] - before) < 3.0
    assert p.ap.ekf.compass == 0


def test_a_compass_that_shows_another_field_is_left(core: Core) -> None:
    p = loiter(core)
    before = p.euler[2]
    fail(p, MAG1_OFS_X=400.0, MAG1_OFS_Y=400.0)
    start = p.now
    p.sticks(15.0)
    assert 9.5 < seconds_until(p, "EKF3 IMU0 switching to compass 1", start) < 10.5
    assert abs(p.euler[2] - before) < 3.0
    assert p.ap.estimate.variance_mag < 0.5


def test_on_the_ground_a_compass_that_shows_another_field_turns_the_heading(core: Core) -> None:
    """A real one, 55 s after boot: 22 degrees off after 8 s, 64 after 23, 110 after 38, and no compass is left."""
    p = Aviator(core, "ardupilot_quad")
    p.fly(55.0 - p.now)
    before = p.ap.estimate.euler.yaw
    fail(p, MAG1_OFS_X=600.0, MAG1_OFS_Y=600.0)
    turned = []
    for seconds in (8.0, 15.0, 15.0):
        p.fly(seconds)
        turned.append(math.degrees(math.remainder(p.ap.estimate.euler.yaw - before, math.tau)))
    assert turned == pytest.approx([22.0, 64.0, 110.0], rel=0.3)
    assert not [text for _, _, text in p.texts if "switching to compass" in text]


def test_a_compass_that_shows_another_field_is_left_where_the_filter_trusts_it(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", EK3_MAG_CAL=4).ready()
    fail(p, MAG1_OFS_X=600.0, MAG1_OFS_Y=600.0)
    p.fly(50.0)
    assert [text for _, _, text in p.texts if "IMU0 switching to compass" in text] == [
        "EKF3 IMU0 switching to compass 1"
    ]
    fail(p, MAG1_OFS_X=0.0, MAG1_OFS_Y=0.0)
    p.fly(12.0)
    assert p.ap.ekf.compass == 0


@pytest.mark.parametrize(
    ("sources", "error", "heeded"),  # the real one's velocity_variance: 0.12 to 0.6 where it is heeded, else 0.01 or 0
    [
        ({"VELZ": 3}, "Z", True), ({"VELZ": 0}, "Z", False), ({"VELZ": 0}, "X", True),
        ({"VELXY": 0}, "X", False), ({"VELXY": 0}, "Z", False),
    ],
)  # fmt: skip
def test_velocities_of_gps_count_as_far_as_they_are_a_source(
    core: Core, sources: dict[str, float], error: str, heeded: bool
) -> None:
    p = Aviator(core, "ardupilot_quad", **{f"EK3_SRC1_{name}": value for name, value in sources.items()}).ready()
    fail(p, **{f"GPS1_VERR_{error}": 3.0})
    p.fly(3.0)
    assert (p.ap.estimate.variance_vel > 0.1) == heeded
    if not heeded:
        assert p.ap.estimate.variance_vel < 0.05 and np.linalg.norm(p.ap.estimate.vel) < 0.1


def test_without_a_source_of_the_heading_there_is_none(core: Core) -> None:
    """As with the real one: tilt is aligned, yaw is not, and GPS is not used."""
    p = Aviator(core, "ardupilot_quad", EK3_SRC1_YAW=0)
    p.fly(55.0)
    assert p.said("EKF3 IMU0 tilt alignment complete") and p.said("EKF3 IMU0 origin set") is not None
    assert not p.said("yaw alignment complete") and not p.said("is using GPS")
    assert abs(p.ap.estimate.yaw) < 0.1 and not p.ap.estimate.position_ok


def test_a_landed_copter_goes_back_to_its_first_compass(core: Core) -> None:
    p = loiter(core)
    fail(p, MAG1_FAIL=1)
    p.sticks(12.0)
    fail(p, MAG1_FAIL=0)
    p.hold(throttle=1000)
    p.set_mode(LAND)
    assert p.fly(60.0, lambda: not p.ap.arming.armed)
    p.fly(2.0)
    assert p.said("EKF3 IMU0 switching to compass 0")
    assert p.ap.ekf.compass == 0


def test_yaw_is_found_when_all_compasses_are_turned_round(core: Core) -> None:
    """They show the field turned by 180 degrees from power-on. The real one takes off to 10 m in GUIDED, goes astray by
    9 m, tells "emergency yaw reset" 4.7 s after its "in-flight yaw alignment complete", and stays in its mode.
    """
    round_about = {f"SIM_MAG{k}_DIA_{axis}": x for k in (1, 2, 3) for axis, x in zip("XYZ", (-1, -1, 1), strict=True)}
    p = Aviator(core, "ardupilot_quad", **round_about).ready()
    p.arm()
    assert p.ask(22, 0, 0, 0, 0, 0, 0, 10.0) == 0  # NAV_TAKEOFF
    p.fly(35.0)
    aligned = next(time for time, _, said in p.texts if said == "EKF3 IMU0 MAG0 in-flight yaw alignment complete")
    assert 1.0 < seconds_until(p, "EKF3 IMU0 emergency yaw reset", aligned) < 7.0
    assert p.said("EKF3 IMU1 emergency yaw reset")
    assert p.mode == GUIDED and not p.said("EKF Failsafe: changed to LAND Mode")
    assert p.ap.ekf.compass_lies and p.ap.yaw_bank.resets == 1
    yaw = euler_of(p.simulation.v.physics.body.q).yaw
    assert abs(wrap_pi(p.ap.estimate.yaw - yaw)) < math.radians(10.0)
    assert np.hypot(*p.pos[:2]) < 60.0 and p.height == approx(10.0, abs=1.5)
    before = p.pos
    p.fly(20.0)
    assert np.hypot(*(p.pos - before)[:2]) < 6.0
