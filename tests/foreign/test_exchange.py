# SPDX-License-Identifier: BSD-3-Clause
"""What laws make of an exchange: pulses in the record, and the time of a line."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.foreign import exchange
from sitl.foreign.body import BodyLines

CASES = [(0, 0.0, 0.0), (900, 0.0, -1.0), (1000, 0.0, -1.0), (1250, 0.25, -0.5), (1500, 0.5, 0.0), (2100, 1.0, 1.0)]


def actuated(plant, pulses):
    lines = BodyLines(plant)
    lines.ask(400, pulses)
    exchange.acted(lines._address, exchange.BEGIN)
    actuators = plant.vehicle.v.actuators
    assert list(actuators.pwm) == list(pulses[:16])
    return np.array(actuators.controls)


@pytest.mark.parametrize(("pulse", "rotor", "servo"), CASES)
def test_a_pulse_is_a_rotors_or_a_servos_control(copter_plant, rover_plant, pulse, rotor, servo):
    assert actuated(copter_plant, (pulse,) * 16).tolist() == [np.float32(rotor)] * 16
    assert actuated(rover_plant, (pulse,) * 16).tolist() == [np.float32(servo)] * 16


def test_the_border_takes_sixteen_of_32_pulses(copter_plant):
    assert actuated(copter_plant, (1500,) * 16 + (2000,) * 16).tolist() == [0.5] * 16


def test_pulses_change_nothing_else(copter_plant):
    vehicle = copter_plant.vehicle
    before = np.frombuffer(bytearray(vehicle.fleet.tobytes()), vehicle.fleet.dtype)  # with the padding
    pulses = (*range(1000, 2000, 100), 0, 900, 2100, 1500, 1501, 65535)
    controls = actuated(copter_plant, pulses)
    before[0]["actuators"]["pwm"], before[0]["actuators"]["controls"] = pulses, controls
    assert vehicle.fleet.tobytes() == before.tobytes()


@pytest.mark.parametrize("time_us", [0, 833, 2500, 999_999, 1_000_000, 86_399_999_999, 999_999_999_999])
def test_a_time_is_fast_by_a_billionth(time_us):
    text = bytearray(64)
    written = text[: exchange.write_time(text, 0, time_us)].decode()
    assert float(written) == pytest.approx(1e-6 * time_us * (1.0 + 1e-9), rel=1e-15)
