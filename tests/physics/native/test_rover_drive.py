# SPDX-License-Identifier: BSD-3-Clause
"""Rovers drive: wheels, motors, rolling resistance; encoders; compiled and plain bits; a recorded turn."""

from __future__ import annotations

import csv
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from pytest import approx

from sitl.core import records
from sitl.core.constants import TICK_S
from sitl.core.kernels import jit_disabled
from sitl.physics.native import truth
from sitl.physics.native.rover.drive import commanded
from sitl.physics.native.rover.state import SteeringServo
from sitl.physics.native.rover.steering import followed
from sitl.vehicle.rover import slow_servo

ROVERS = ["erle_rover", "erle_rover_small", "ardupilot_rover", "skid_rover"]


@pytest.mark.parametrize("frame", ROVERS)
def test_stands_still_without_throttle(rig, frame):
    r = rig(frame, heading=30.0)
    r.command(0.0, 0.0)
    r.move(100)
    assert list(r.p.body.pos) == [0.0, 0.0, 0.0]
    assert list(r.p.body.specific_force) == [0.0, 0.0, -9.80665]
    assert list(r.p.wheels.distance) == [0.0, 0.0]


@pytest.mark.parametrize(("frame", "speed"), [("erle_rover", 1.5875), ("erle_rover_small", 0.3175)])
def test_erle_rovers_drive_at_5_rad_s_at_1900_us(rig, frame, speed):
    r = rig(frame)
    for sign in (1.0, -1.0):
        r.command(0.0, 0.8 * sign)
        r.move(4000)
        assert list(r.p.body.vel) == approx([sign * speed, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("delay", [0, 1, 80, 400])
def test_a_late_servo_repeats_its_commands(delay):
    servo = SteeringServo()
    slow_servo(servo, delay, 0.0)
    assert servo.is_slow == (delay > 0)
    shown = [followed(servo, float(n)) for n in range(1000)]
    assert shown == [float(max(n - delay, 0)) for n in range(1000)]


@pytest.mark.parametrize("hz", [1.0, 5.0, 20.0])
def test_the_servos_low_pass_is_of_second_order(hz):
    """A command of the corner frequency comes out at 0.707 of its size, a quarter turn late; a steady one whole."""
    servo = SteeringServo()
    slow_servo(servo, 0, hz)
    times = np.arange(round(20.0 / hz / TICK_S)) * TICK_S
    shown = np.array([followed(servo, math.sin(2.0 * math.pi * hz * t)) for t in times])
    last = times > times[-1] - 10.0 / hz
    in_phase, late = (2.0 * np.mean(shown[last] * wave(2.0 * math.pi * hz * times[last])) for wave in (np.sin, np.cos))
    assert math.hypot(in_phase, late) == approx(math.sqrt(0.5), rel=0.02) and math.atan2(late, in_phase) == approx(
        -0.5 * math.pi, abs=0.03
    )
    for _ in range(round(5.0 / hz / TICK_S)):
        steady = followed(servo, 0.3)
    assert steady == approx(0.3, abs=1e-3)


@pytest.mark.parametrize("throttle", [1.0, 0.3, -0.5])
def test_ardupilots_rover_accelerates_by_its_law(rig, throttle):
    r = rig("ardupilot_rover")
    r.command(0.0, throttle)
    for _ in range(100):
        before = float(r.p.body.vel[0])
        r.move()
        mid = 0.5 * (before + float(r.p.body.vel[0]))
        assert r.p.body.acc_ned[0] == approx(10.0 * (throttle * 20.0 - mid) / 20.0, rel=1e-5)


def test_wheels_follow_as_first_order_and_within_the_motors_pull(rig):
    r = rig("skid_rover", rolling_resistance=0.0, drive_accel=0.0, grip=100.0)
    r.command(0.8, 0.8)
    r.move(80)  # 0.2 s: one time constant
    assert r.p.wheels.forward == approx(2.1 * (1.0 - math.exp(-1.0)), rel=1e-6)
    r = rig("skid_rover", rolling_resistance=0.0, drive_accel=1.0)
    r.command(0.8, 0.8)
    r.move(80)
    assert r.p.wheels.forward == approx(0.2)


def test_rolling_resistance_holds_against_little_throttle_and_stops_without(rig):
    r = rig("erle_rover")
    r.command(0.0, 0.8 * 0.025)  # less than the 2.7 % that it takes
    r.move(400)
    assert r.p.wheels.forward == 0.0
    assert r.p.wheels.power > 0.0  # the motor pulls all the same
    r.command(0.0, 0.8)
    r.move(1000)
    r.command(0.0, 0.0)
    r.move(800)
    assert r.p.wheels.forward == 0.0
    assert r.p.wheels.power == 0.0


def test_wheels_spin_when_the_tyres_do_not_hold(rig):
    r = rig("erle_rover", grip=0.1, drive_accel=0.0)
    r.command(0.0, 0.8)
    r.move(40)
    assert r.p.body.specific_force[0] == approx(0.1 * 0.56 * 9.80665, rel=1e-4)
    assert r.p.wheels.distance[0] > 2.0 * r.p.body.pos[0] > 0.0  # the encoder counts the spin
    r.move(4000)
    assert r.p.wheels.forward == approx(r.p.wheels.speed[0])


@pytest.mark.parametrize(("control", "command"), [(0.4, 0.5), (2.0, 1.0), (-2.0, -1.0), (math.nan, 0.0)])
def test_controls_are_limited_and_nan_is_none(control, command):
    assert commanded(control, 1.0 / 0.8) == command


def test_power_is_force_by_speed_at_no_load(rig):
    r = rig("erle_rover")
    r.command(0.0, 0.8)
    r.move(4000)
    no_load = 1.5875 + 0.3 * 0.015 * 9.80665
    assert r.p.wheels.power == approx(882.0 * 0.015 * 9.80665 * no_load / 0.7, rel=0.01)
    r.command(0.0, 0.2)
    r.move(1)
    assert r.p.wheels.power == 0.0  # braking gives nothing back


def test_ardupilots_battery_gives_50_a_at_full_throttle(rig):
    r = rig("ardupilot_rover")
    r.command(0.0, -1.0)
    r.step(1)
    assert r.p.battery.current == approx(50.0)
    assert r.p.battery.voltage == approx(12.6 - 0.7)


@pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")
@pytest.mark.parametrize("frame", ["erle_rover", "ardupilot_rover", "skid_rover"])
def test_compiled_and_plain_python_drive_the_same_bits(rig, frame):
    plain, compiled = rig(frame, gps_start=0.01, grip=0.3), rig(frame, gps_start=0.01, grip=0.3)
    for k, (first, second) in enumerate(np.random.default_rng(1).uniform(-1.0, 1.0, (200, 2))):
        for r in (plain, compiled):
            if k % 20 == 0:
                r.command(first, second)
        plain.step()
        compiled.step_compiled()
        assert records.first_difference(plain.fleet[0], compiled.fleet[0]) is None
    assert plain.v.sensors.gps_count > 0
    assert plain.p.wheels.forward != 0.0


def test_wheel_encoders_count_at_their_rate(rig):
    r = rig("erle_rover")
    r.command(0.0, 0.8)
    r.step(800)
    s = r.v.sensors
    assert s.wheel_count == 100
    assert list(s.wheel_distance) == approx(list(r.p.wheels.distance), abs=0.035)  # up to 7 ticks ago
    counts = s.wheel_distance[0] / 0.002
    assert counts == approx(round(counts), abs=1e-6)


def test_no_encoder_no_samples(rig):
    r = rig("ardupilot_rover")
    r.command(0.0, 0.8)
    r.step(20)
    assert r.v.sensors.wheel_count == 0
    assert list(r.v.sensors.wheel_distance) == [0.0, 0.0]


def test_power_on_forgets_the_drive(rig):
    r, fresh = rig("skid_rover", seed=2), rig("skid_rover", seed=2)
    r.command(0.3, 0.8)
    r.step(20)
    r.power_on(seed=2)
    assert records.first_difference(r.fleet[0], fresh.fleet[0]) is None


RECORDING = Path(__file__).parent / "data" / "ardupilot_rover_turn.csv"


def test_the_same_pulses_give_the_same_path(rig):
    with RECORDING.open() as file:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]
    r = rig("ardupilot_rover", heading=math.degrees(rows[0]["yaw"]))
    ticks = 0
    for before, now in pairwise(rows):
        # Pulses are renewed at 50 Hz, recorded at 25: their mean is the nearest that is known of what came between.
        steering, throttle = ((0.5 * (before[name] + now[name]) - 1500.0) / 500.0 for name in ("servo1", "servo3"))
        r.command(steering, throttle)
        due = round(now["t"] / 0.0025)
        r.move(due - ticks)
        ticks = due
        assert list(r.p.body.pos[:2]) == approx([now["north"], now["east"]], abs=0.12)
        assert math.remainder(truth.read(r.v).euler[2] - now["yaw"], 2.0 * math.pi) == approx(0.0, abs=0.015)
        assert r.p.wheels.forward == approx(now["speed"], abs=0.03)
    assert r.p.body.pos[1] > 19.0
