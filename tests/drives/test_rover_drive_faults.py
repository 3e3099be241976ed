# SPDX-License-Identifier: BSD-3-Clause
"""A rover's faults, beside those of a real ArduPilot 4.7-dev with the same airframe, in MANUAL at 1700 us."""

from __future__ import annotations

import math

import pytest

from sitl.simulation import Core
from tests.drives.rover_driver import MANUAL, Driver

STEERING, THROTTLE = 1, 3
"""Outputs."""


def at_speed(core: Core, frame: str = "ardupilot_rover", seconds: float = 8.0) -> Driver:
    p = Driver(core, frame).armed_in(MANUAL)
    p.sticks(seconds, throttle=1700)
    return p


def test_a_weak_motor(core: Core) -> None:
    """ArduPilot: from 6.5 m/s to 2.3 m/s in 7 s with a share of 0.3, to a stand with 0, and on as before."""
    p = at_speed(core)
    full = p.speed
    p.simulation.fail(f"motor:{THROTTLE}=0.3")
    p.sticks(7.0, throttle=1700)
    assert p.speed / full == pytest.approx(2.28 / 6.8, abs=0.05)
    p.simulation.fail(f"motor:{THROTTLE}")
    p.sticks(8.0, throttle=1700)
    assert p.speed < 0.15
    p.simulation.repair("motor")
    p.sticks(8.0, throttle=1700)
    assert p.speed == pytest.approx(full, rel=0.1)


def test_steering_without_force(core: Core) -> None:
    """ArduPilot goes straight on, whatever the stick says; afterwards it turns again."""
    p = at_speed(core)
    p.simulation.fail(f"servo:{STEERING}")
    p.sticks(1.0, 1800, 1700)
    heading = p.heading
    p.sticks(3.0, 1800, 1700)
    assert p.heading == pytest.approx(heading, abs=2.0)
    p.simulation.repair("servo")
    p.sticks(1.0, 1800, 1700)
    assert abs(p.heading - heading) > 20.0


def test_a_slow_servo_and_a_slow_motor(core: Core) -> None:
    """SIM_SERVO_SPEED: seconds for 60 degrees. SIM_ENGINE_LAG: the motor's time constant."""
    p = at_speed(core, "erle_rover", 4.0)
    wheels, derived = p.simulation.v.physics.wheels, p.simulation.v.physics.derived
    before = bytes(derived._bytes)
    p.simulation.fail("servo/slow=4")
    p.sticks(0.5, 1500, 1700)
    angle = wheels.angle
    p.sticks(0.5, 2000, 1700)
    assert math.degrees(wheels.angle - angle) == pytest.approx(60.0 / 4.0 * 0.5, abs=1.0)
    p.simulation.repair("servo/slow")
    p.sticks(0.5, 2000, 1700)
    assert wheels.angle == pytest.approx(p.simulation.v.physics.airframe.steering_angle, rel=0.05)
    p.simulation.fail("motor/slow=2")
    full = wheels.speed.x
    p.sticks(1.0, 1500, 1500)
    assert 0.45 < wheels.speed.x / full < math.exp(-0.5), "rolling resistance takes some of it"
    p.simulation.repair("motor")
    p.sticks(1.0, 1500, 1500)
    assert wheels.speed.x < 0.05 * full
    assert bytes(derived._bytes) == before


def test_a_late_steering_servo(core: Core) -> None:
    """SIM_SERVO_DELAY: the wheels begin to turn so much later."""
    p = at_speed(core, "erle_rover", 4.0)
    wheels = p.simulation.v.physics.wheels
    p.simulation.fail("servo/delayed=0.5")
    p.sticks(1.0, 1500, 1700)
    straight = wheels.angle
    p.sticks(0.45, 2000, 1700)
    assert wheels.angle == pytest.approx(straight, abs=0.02)
    p.sticks(0.5, 2000, 1700)
    assert wheels.angle > straight + 0.2
    p.simulation.repair("servo")
    assert not wheels.servo.is_slow


@pytest.mark.parametrize("frame", ["ardupilot_rover", "skid_rover"])
def test_outputs_that_are_stuck(core: Core, frame: str) -> None:
    """They stay as they were, and are as the autopilot says when that is over. ArduPilot has no parameter for it."""
    p = at_speed(core, frame, 4.0)
    p.simulation.fail("servo/stuck")
    p.sticks(4.0, 1900, 1500)
    assert p.speed > 0.5 and abs(p.simulation.v.physics.body.rates.z) < 0.02
    p.simulation.repair("servo")
    p.sticks(8.0)
    assert abs(p.speed) < 0.2


def test_a_stuck_and_a_noisy_channel(core: Core) -> None:
    p = at_speed(core)
    p.simulation.fail("rc:3/stuck")
    p.sticks(3.0)
    assert p.speed > 1.0 and p.ap.rc.channels[2] == 1700
    p.simulation.repair("rc")
    p.sticks(8.0)
    assert abs(p.speed) < 0.2
    p.simulation.fail("rc/garbage=50")
    seen = set()
    for _ in range(50):
        p.sticks(0.1)
        seen.add(int(p.ap.rc.channels[0]))
    assert 1450 <= min(seen) < 1475 and 1525 < max(seen) <= 1550
