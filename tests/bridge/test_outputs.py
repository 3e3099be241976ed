# SPDX-License-Identifier: BSD-3-Clause
"""Servo outputs and relays: set and repeated by commands, in the rhythm of ArduPilot 4.7."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.outputs import OutputService
from sitl.core.mavlink import MavCmd
from tests.bridge.fakes import Bench, FakeRover

ACCEPTED, DENIED, FAILED = 0, 2, 4
SET_RELAY, REPEAT_RELAY, SET_SERVO, REPEAT_SERVO = (
    MavCmd.DO_SET_RELAY,
    MavCmd.DO_REPEAT_RELAY,
    MavCmd.DO_SET_SERVO,
    MavCmd.DO_REPEAT_SERVO,
)


def bench(**params: float) -> Bench:
    """A rover with two relays on pins 1 and 2."""
    vehicle = FakeRover()
    pins = {"RELAY1_FUNCTION": 1.0, "RELAY1_PIN": 1.0, "RELAY2_FUNCTION": 1.0, "RELAY2_PIN": 2.0}
    vehicle.parameters.update(pins | params)
    return Bench(vehicle)


def status(b: Bench) -> tuple[int, int]:
    """(present, on) of RELAY_STATUS."""
    (m,) = b.telemetry("RELAY_STATUS")
    return m.present, m.on


def test_relays_are_switched_on_their_pins() -> None:
    b = bench()
    assert status(b) == (3, 0)
    assert b.command(SET_RELAY, 0, 1) == ACCEPTED
    assert (status(b), b.vehicle.parameters["SIM_PIN_MASK"]) == ((3, 1), 2.0)
    assert b.command(SET_RELAY, 1, 1) == ACCEPTED
    assert (status(b), b.vehicle.parameters["SIM_PIN_MASK"]) == ((3, 3), 6.0)
    assert b.command(SET_RELAY, 0, 2) == ACCEPTED  # the other way
    assert status(b) == (3, 2)
    assert b.command(SET_RELAY, 2, 1) == FAILED
    assert b.command(SET_RELAY, 7, 1) == FAILED
    b.vehicle.parameters["SIM_PIN_MASK"] = 2.0
    assert status(b) == (3, 1)


def test_parameters_of_relays() -> None:
    b = bench(RELAY1_DEFAULT=1.0, RELAY2_INVERTED=1.0, RELAY6_FUNCTION=1.0, RELAY6_PIN=-1.0)
    assert (status(b), b.vehicle.parameters["SIM_PIN_MASK"]) == ((35, 1), 6.0)
    assert b.command(SET_RELAY, 1, 1) == ACCEPTED
    assert (status(b), b.vehicle.parameters["SIM_PIN_MASK"]) == ((35, 3), 2.0)
    assert b.command(SET_RELAY, 5, 1) == ACCEPTED  # has no pin
    assert status(b) == (35, 3)


def changes(b: Bench, seconds: float, read: Any) -> list[tuple[float, Any]]:
    """(time from now [s], value) whenever it is another one."""
    start, found = b.vehicle.time_us, [(0.0, read())]
    while b.vehicle.time_us - start < seconds * 1e6:
        b.run(0.0025)
        if read() != found[-1][1]:
            found.append((round((b.vehicle.time_us - start) * 1e-6, 2), read()))
    return found


def test_a_relay_goes_over_and_back() -> None:
    b = bench()
    assert b.command(REPEAT_RELAY, 0, 3, 1.0) == ACCEPTED
    seen = changes(b, 5.0, lambda: status(b)[1])
    assert seen == [(0.0, 1), (0.5, 0), (1.0, 1), (1.5, 0), (2.0, 1), (2.5, 0)]
    assert b.command(REPEAT_RELAY, 3, 1, 1.0) == FAILED
    assert b.command(REPEAT_RELAY, 0, 1e9, 1.0) == DENIED
    assert b.command(REPEAT_RELAY, 0, 0, 1.0) == ACCEPTED
    assert changes(b, 1.0, lambda: status(b)[1]) == [(0.0, 0)]


def servos(b: Bench) -> list[tuple[int, int]]:
    """Pulses that were set since the last call."""
    calls = [call[1:] for call in b.autopilot.calls if call[0] == "set_servo"]
    b.autopilot.calls.clear()
    return calls


def test_a_servo_goes_to_and_fro() -> None:
    b = bench()
    assert b.command(SET_SERVO, 9, 1700) == ACCEPTED
    assert servos(b) == [(9, 1700)]
    assert b.command(REPEAT_SERVO, 10, 1800, 3, 1.0) == ACCEPTED
    b.run(1.2)
    b.run(3.0)
    assert [pulse for _, pulse in servos(b)][1:] == [1800, 1500, 1800, 1500, 1800, 1500]
    assert b.command(REPEAT_SERVO, 10, 1800, -1, 1.0) == ACCEPTED
    b.run(60.1)
    assert len(servos(b)) > 100
    restored = b.bridge.snapshot()
    assert b.command(SET_SERVO, 10, 1234) == ACCEPTED  # ends it
    b.run(3.0)
    assert [pulse for _, pulse in servos(b)] == [1234]
    b.bridge.restore(restored)
    b.run(1.0)
    assert len(servos(b)) == 2


def test_outputs_that_have_a_function_are_refused() -> None:
    b = bench()
    b.client.send(mavlink.MAVLink_command_long_message(1, 1, SET_SERVO, 0, 1, 1500, 0, 0, 0, 0, 0))  # steering
    b.run(0.1)
    assert "ServoRelayEvent: Channel 1 is already in use" in [m.text for m in b.client.receive("STATUSTEXT")]
    assert b.command(SET_SERVO, 17, 1500) == FAILED
    assert b.command(SET_SERVO, 0, 1500) == FAILED
    assert b.command(REPEAT_SERVO, 1, 1500, 2, 1.0) == FAILED
    assert servos(b) == []


def test_there_is_no_such_output() -> None:
    b = bench()
    for number in (-40, -1, 0, 17, 32, 33, 1000):
        for count in (0, 2):
            assert b.command(REPEAT_SERVO, number, 1500, count, 1.0) == FAILED


def test_missions_do_the_same() -> None:
    b = bench()
    b.bridge.carry_out(MissionItem(SET_RELAY, p1=1.0, p2=1.0))
    assert status(b) == (3, 2)
    b.bridge.carry_out(MissionItem(REPEAT_RELAY, p1=0.0, p2=1.0, p3=1.0))
    b.run(0.1)
    assert status(b) == (3, 3)
    b.bridge.carry_out(MissionItem(SET_SERVO, p1=9.0, p2=1600.0))
    b.bridge.carry_out(MissionItem(REPEAT_SERVO, p1=10.0, p2=1900.0, p3=1.0, p4=1.0))
    assert servos(b) == [(9, 1600), (10, 1900), (10, 1900)]
    b.run(0.6)
    assert status(b) == (3, 3)  # one thing at a time: the relay stays
    assert servos(b) == [(10, 1500)]


def test_setting_their_parameters_is_no_surprise() -> None:
    """No text says that they have no effect."""
    b = bench()
    b.client.send(mavlink.MAVLink_param_set_message(1, 1, b"RELAY3_FUNCTION", 1.0, mavlink.MAV_PARAM_TYPE_INT8))
    b.run(0.1)
    assert not [m.text for m in b.client.receive("STATUSTEXT") if "RELAY" in m.text]
    assert status(b)[0] == 7


@pytest.mark.parametrize("pulse", [-1.0, 3001.0, 1e30, -1e30])
def test_pulses_out_of_range_are_refused(pulse: float) -> None:
    """By missions, too: nothing is set, and the mission goes on."""
    b = bench()
    assert b.command(SET_SERVO, 9, pulse) == DENIED
    assert b.command(REPEAT_SERVO, 9, pulse, 3, 1.0) == DENIED
    for number in (SET_SERVO, REPEAT_SERVO):
        b.bridge.get(OutputService).carry_out(MissionItem(number, p1=9.0, p2=pulse, p3=3.0, p4=1.0))
    b.run(2.0)
    assert servos(b) == []


@pytest.mark.parametrize("number", [-18.0, 0.0, 17.0, 999999999.0, 3.4e38])
def test_outputs_that_do_not_exist_are_refused(number: float) -> None:
    b = bench()
    assert b.command(SET_SERVO, number, 1500) == FAILED
    for count in (0, 1, -1):
        assert b.command(REPEAT_SERVO, number, 1500, count, 1.0) == FAILED
    assert b.command(SET_RELAY, -abs(number) - 1.0, 1) == FAILED


def test_numbers_that_are_none_are_refused() -> None:
    b = bench()
    for k in range(4):
        values = [9.0, 1500.0, 3.0, 1.0]
        values[k] = math.nan
        assert b.command(REPEAT_SERVO, *values) == DENIED
    assert servos(b) == []


def test_the_fraction_of_an_output_number_is_cut_off() -> None:
    """As by ArduPilot."""
    b = bench()
    assert b.command(SET_SERVO, 9.5, 1700) == ACCEPTED
    assert servos(b) == [(9, 1700)]


def test_what_repeats_is_ended_by_its_own_output_or_relay_alone() -> None:
    b = bench()
    assert b.command(REPEAT_SERVO, 10, 1800, -1, 1.0) == ACCEPTED
    servos(b)
    assert b.command(SET_SERVO, 9, 1700) == b.command(SET_RELAY, 1, 1) == ACCEPTED
    b.run(0.5)
    assert servos(b) == [(9, 1700), (10, 1500)]
    assert b.command(REPEAT_RELAY, 0, -1, 1.0) == ACCEPTED
    assert changes(b, 1.2, lambda: status(b)[1] & 1) == [(0.0, 1), (0.5, 0), (1.0, 1)]
    assert b.command(SET_RELAY, 0, 0) == ACCEPTED
    assert changes(b, 2.0, lambda: status(b)[1] & 1) == [(0.0, 0)]


@pytest.mark.parametrize("number", [9, 16])
def test_repeated_no_times_an_output_stays_as_it_is(number: int) -> None:
    b = bench()
    b.vehicle.v.actuators.pwm[number - 1] = 1234
    assert b.command(REPEAT_SERVO, number, 1800, 0, 1.0) == ACCEPTED
    b.run(3.0)
    assert servos(b) == [(number, 1234)]


@pytest.mark.parametrize("period", [0.0, -1.0, 0.02])
def test_it_goes_to_and_fro_fifty_times_a_second_at_most(period: float) -> None:
    b = bench()
    assert b.command(REPEAT_SERVO, 10, 1800, -1, period) == ACCEPTED
    servos(b)
    b.run(1.0)
    assert len(servos(b)) == 50


def test_no_text_is_lost_on_an_output_that_there_is_not() -> None:
    b = bench()
    for number, said in ((0, 0), (-3, 0), (1, 1), (17, 1)):
        b.client.receive()
        b.client.send(mavlink.MAVLink_command_long_message(1, 1, SET_SERVO, 0, number, 1500, 0, 0, 0, 0, 0))
        b.bridge.receive()
        assert len(b.client.receive("STATUSTEXT")) == said, number
