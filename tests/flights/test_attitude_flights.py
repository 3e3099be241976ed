# SPDX-License-Identifier: BSD-3-Clause
"""SET_ATTITUDE_TARGET, and how well attitude, heading and hover are held."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler
from sitl.physics.native import truth
from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES, ALT_HOLD, Aviator

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)


def fly_attitude(
    p: Aviator, seconds: float, roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0, thrust: float = 0.5
) -> None:
    """Attitude [deg] at 20 Hz."""
    q = list(quat_from_euler(Euler(*np.radians((roll, pitch, yaw)))))
    for _ in range(round(seconds * 20)):
        p.send("SET_ATTITUDE_TARGET", type_mask=0b111, q=q, thrust=thrust)
        p.fly(0.05)


@BOTH
def test_attitude_with_climb_rate(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    yaw, start = p.euler[2], p.now
    for roll, pitch in ((10.0, 0.0), (0.0, -20.0), (-15.0, 15.0)):
        fly_attitude(p, 2.5, roll, pitch, yaw)
        assert p.euler[:2] == pytest.approx([roll, pitch], abs=1.5)
    assert np.ptp(p.since(start)[:, 3]) < 0.5, "thrust 0.5 holds the height"
    fly_attitude(p, 3.0, yaw=yaw, thrust=0.75)
    assert -p.vel[2] == pytest.approx(1.25, abs=0.2)
    fly_attitude(p, 4.0, yaw=yaw, thrust=0.25)
    assert p.vel[2] == pytest.approx(0.75, abs=0.2)


@BOTH
def test_a_stale_attitude_levels_off(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    fly_attitude(p, 2.0, 10.0, 0.0, p.euler[2], 0.7)
    p.fly(2.5)
    assert p.euler[0] > 8.0
    p.fly(3.0)
    assert np.abs(p.euler[:2]).max() < 1.5
    height = p.height
    p.fly(3.0)
    assert p.height == pytest.approx(height, abs=0.4)


@BOTH
def test_body_rates(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    for _ in range(60):
        p.send(
            "SET_ATTITUDE_TARGET", type_mask=0b10000000, thrust=0.5,
            body_yaw_rate=0.5,
        )  # fmt: skip
        p.fly(0.05)
    assert truth.read(p.simulation.v).rates[2] == pytest.approx(0.5, abs=0.04)
    assert np.abs(p.euler[:2]).max() < 2.0


@BOTH
def test_thrust_as_thrust(core: Core, frame: str) -> None:
    p = Aviator(core, frame, GUID_OPTIONS=8).hover()
    yaw, hover = p.euler[2], float(p.ap.params.MOT_THST_HOVER)
    fly_attitude(p, 2.0, yaw=yaw, thrust=hover + 0.15)
    assert p.vel[2] < -3.0
    fly_attitude(p, 2.0, yaw=yaw, thrust=hover - 0.15)
    p.fly(6.0)
    assert abs(p.vel[2]) < 0.3, "stale: holds its height"


@BOTH
def test_take_off_by_attitude(core: Core, frame: str) -> None:
    p = Aviator(core, frame).ready()
    p.arm(3.0)
    fly_attitude(p, 6.0, yaw=p.euler[2], thrust=0.75)
    assert p.height > 3.0
    assert -p.vel[2] == pytest.approx(1.25, abs=0.2)


@BOTH
@pytest.mark.parametrize("axis", ["roll", "pitch"])
def test_lean_step(core: Core, frame: str, axis: str) -> None:
    """18 degrees by stick: nine tenths within half a second, hardly any overshoot, close to the shaped target."""
    p = Aviator(core, frame).hover(20.0)
    p.sticks(0.5)
    p.set_mode(ALT_HOLD)
    p.sticks(2.0)
    k = 0 if axis == "roll" else 1
    p.hold(**{axis: 1750})
    lean, wanted = [], []
    for _ in range(150):
        p.override(*p._pulses or ())
        p.simulation.advance(0.01)
        lean.append(p.euler[k])
        wanted.append(math.degrees(p.ap.control.attitude.target_euler[k]))
    assert wanted[-1] == pytest.approx(18.2, abs=0.3)
    assert lean[50] > 0.9 * wanted[-1]
    assert max(lean) < wanted[-1] + 1.5
    assert np.abs(np.array(lean) - wanted).max() < 2.5


@pytest.mark.parametrize(("frame", "lag"), [("erle_copter", 6.5), ("ardupilot_quad", 12.0)])
def test_quarter_turn(core: Core, frame: str, lag: float) -> None:
    """Follows its target within ``lag`` [deg] and settles.

    The Erle-Copter's rotors give little torque: it turns with 70 deg/s^2; the quad with 270 and ArduPilot's gains.
    """
    p = Aviator(core, frame).hover()
    start = p.euler[2]
    assert p.ask(115, 90, 0, 1, 1, wait=0.01) == 0
    off, turned = [], []
    for _ in range(500):
        p.simulation.advance(0.01)
        goal = math.degrees(p.ap.control.attitude.target_euler[2])
        off.append((p.euler[2] - goal + 180.0) % 360.0 - 180.0)
        turned.append((p.euler[2] - start + 180.0) % 360.0 - 180.0)
    assert np.abs(off).max() < lag
    assert turned[300] == pytest.approx(turned[-1], abs=3.0)
    assert max(turned) - turned[-1] < 5.0


@pytest.mark.parametrize(
    ("frame", "place", "lean", "pulse"), [("erle_copter", 0.4, 0.6, 14.0), ("ardupilot_quad", 0.05, 0.1, 1.5)]
)
def test_hover_is_quiet(core: Core, frame: str, place: float, lean: float, pulse: float) -> None:
    """Standard deviations over 20 s: position [m], lean [deg], motor pulses [us]."""
    p = Aviator(core, frame).hover()
    p.fly(10.0)
    start, pulses = p.now, []
    for _ in range(500):
        p.fly(0.04)
        pulses.append(np.array(p.simulation.v.actuators.pwm[:4], float))
    rows = p.since(start)
    assert rows[:, 1:4].std(axis=0).max() < place
    assert rows[:, 7:9].std(axis=0).max() < lean
    assert np.std(pulses, axis=0).max() < pulse


def test_battery_of_a_ten_minute_hover(core: Core) -> None:
    """150 W: 10 to 15 A of a 5 Ah battery, about two fifths of it; the voltage sags with it."""
    p = Aviator(core).hover()
    volts = float(p.ap.battery.voltage)
    p.fly(600.0)
    battery = p.ap.battery
    assert 10.0 < battery.current < 15.0
    assert 1800.0 < battery.consumed_mah < 2400.0
    assert battery.remaining_pct == pytest.approx(100.0 - battery.consumed_mah / 50.0, abs=1.0)
    assert 0.5 < volts - battery.voltage < 1.5
    assert np.linalg.norm(p.pos - [0.0, 0.0, -10.0]) < 1.5


@BOTH
@pytest.mark.parametrize("yaw", [1500, 2000])
def test_reversal_of_a_full_diagonal_lean_keeps_to_the_lean_limit(core: Core, frame: str, yaw: int) -> None:
    """The Erle-Copter went to 40 degrees: its limits of angular acceleration were too unlike."""
    p = Aviator(core, frame).hover(30.0)
    p.sticks(0.5)
    p.set_mode(ALT_HOLD)
    p.sticks(1.0)
    start = p.now
    p.sticks(1.5, roll=2000, pitch=1000, yaw=yaw)
    p.sticks(1.0, roll=1000, pitch=2000, yaw=3000 - yaw)
    roll, pitch = np.radians(p.since(start)[:, 7:9]).T
    assert np.degrees(np.arccos(np.cos(roll) * np.cos(pitch))).max() < 33.0
