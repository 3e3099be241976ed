# SPDX-License-Identifier: BSD-3-Clause
import math

import pytest
from pytest import approx

from sitl.core.algebra import quat_from_euler, rotate
from sitl.core.constants import GRAVITY
from sitl.core.vectors import Euler
from sitl.physics.native.copter.wrench import act


def spin(r, command):
    """All rotors running steadily at a command."""
    top = 1.0 if r.p.airframe.thrust_model == 1 else float(r.p.airframe.speed_max)
    r.p.rotors.command[:4] = command
    r.p.rotors.speed[:4] = command * top


def steady(r, speed, climb=0.0):
    """(lean [rad], command) with which the vehicle keeps a forward speed and a climb rate [m/s]."""
    low, high = 0.0, 1.3
    for _ in range(30):
        lean = 0.5 * (low + high)
        r.p.body.q = quat_from_euler(Euler(0.0, -lean, 0.0))
        r.p.body.vel = (speed, 0.0, -climb)
        c_low, c_high = 0.0, 1.0
        for _ in range(30):
            command = 0.5 * (c_low + c_high)
            spin(r, command)
            north, _, down = rotate(r.p.body.q, act(r.p).force)
            if -down > GRAVITY * float(r.p.airframe.mass):
                c_high = command
            else:
                c_low = command
        if north > 0.0:
            high = lean
        else:
            low = lean
    return lean, command


@pytest.mark.parametrize(
    ("speed", "lean_deg", "tolerance"),
    [(3.0, 6.0, 0.15), (5.71, 14.2, 0.3), (15.08, 45.0, 0.5)],
    ids=["recorded cruise at 3 m/s", "recorded top speed of a mission leg", "reference of the model"],
)
def test_lean_of_ardupilots_quad(rig, speed, lean_deg, tolerance):
    lean, _ = steady(rig(), speed)
    assert math.degrees(lean) == approx(lean_deg, abs=tolerance)


@pytest.mark.parametrize(
    ("climb", "pwm"), [(0.0, 1590.7), (1.63, 1606.0), (2.53, 1619.0)], ids=["hover", "RTL climb", "take-off"]
)
def test_throttle_of_ardupilots_quad_as_recorded(rig, climb, pwm):
    _, command = steady(rig(), 0.0, climb)
    assert 1150.0 + 800.0 * command == approx(pwm, abs=2.0)


def test_erle_copter_hovers_at_570_rad_s(rig):
    r = rig("erle_copter")
    r.fly()
    _, command = steady(r, 0.0)
    assert command * 838.0 == approx(571.0, abs=3.0)


@pytest.mark.parametrize("frame", ["ardupilot_quad", "erle_copter"])
def test_each_motor_turns_the_body_as_the_mixer_expects(rig, frame):
    """More of motor 1 (right / front right, counter-clockwise): roll left, yaw right; and so on."""
    signs = {
        "ardupilot_quad": [(-1, 0, 1), (1, 0, 1), (0, 1, -1), (0, -1, -1)],
        "erle_copter": [(-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, -1, -1)],
    }[frame]
    for motor, expected in enumerate(signs):
        r = rig(frame)
        spin(r, 0.5)
        r.p.rotors.speed[motor] *= 1.1
        r.p.rotors.command[motor] *= 1.1
        moments = act(r.p).torque
        assert [0 if abs(m) < 1e-9 else int(math.copysign(1, m)) for m in moments] == list(expected)


def test_speed_lags_as_first_order_up_and_down(rig):
    r = rig("erle_copter")
    r.command(0.838)
    r.move(5)  # 12.5 ms: one time constant
    assert r.p.rotors.speed[0] == approx(838.0 * (1.0 - math.exp(-1.0)), rel=1e-6)
    r.move(200)
    r.command(0.0)
    r.move(10)  # 25 ms
    assert r.p.rotors.speed[0] == approx(838.0 * math.exp(-1.0), rel=1e-5)


def test_controls_outside_the_spin_range_and_nan(rig):
    r = rig()
    r.command(0.1, 0.95, 1.0, math.nan)
    r.move(10)
    assert r.p.rotors.command[:4].tolist() == approx([0.0, 1.0, 1.0, 0.0], abs=1e-6)


def test_rotor_drag_opposes_the_air(rig):
    r = rig("erle_copter", drag_area=(0.0, 0.0, 0.0))
    spin(r, 0.68)
    still = act(r.p).force
    r.p.wind.vel = (0.0, 5.0, 0.0)
    windy = act(r.p).force
    speed = 0.68 * 838.0
    assert windy.y - still.y == approx(4.0 * 8.06428e-5 * speed * 5.0)
    assert windy.x == approx(still.x, abs=1e-12)


def test_a_motor_fault_takes_its_share_of_the_pulse(rig):
    """As ArduPilot's: at 1000 + share (pulse - 1000) us."""
    r = rig("erle_copter")
    r.p.rotors.share[2] = 0.5
    r.command(0.6, 0.3, 0.6, 0.6)
    r.move(4000)
    assert r.p.rotors.speed[2] == approx(r.p.rotors.speed[1], rel=1e-9)
    assert (
        r.p.rotors.thrust[2] == approx(r.p.rotors.thrust[1], rel=1e-9) and r.p.rotors.thrust[2] < r.p.rotors.thrust[0]
    )
