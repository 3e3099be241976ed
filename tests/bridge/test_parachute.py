# SPDX-License-Identifier: BSD-3-Clause
"""The parachute: answers, texts, pulses and times are those of ArduCopter 4.7 with the same parameters."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.aux_switch import HIGH, LOW, MIDDLE
from sitl.bridge.services.parachute import ParachuteService
from sitl.bridge.services.parameter_protocol import ParameterService
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.bridge.fakes import FakeRover
from tests.bridge.test_payload import Fitted, bench, pulse
from tests.flights.aviator import FLIP, STABILIZE, Aviator, Item

DISABLE, ENABLE, RELEASE = 0, 1, 2
ACCEPTED, UNSUPPORTED, FAILED = 0, 3, 4
CHUTE = {"CHUTE_ENABLED": 1.0, "CHUTE_TYPE": 10.0, "SERVO9_FUNCTION": 27.0}


def packed(core: Core, height: float, **params: float) -> Aviator:
    """A copter in the air with a parachute."""
    p = Aviator(core, "ardupilot_quad", **{**CHUTE, **params}).hover(height)
    p.texts.clear()
    return p


def said(p: Aviator) -> list[str]:
    """What was said of the parachute and the motors."""
    texts = [text.text for text in p.texts]
    return [text for text in texts if "achute" in text or "Disarming" in text or "Crash" in text]


def turns(p: Aviator) -> bool:
    """Whether it is armed now; a client hears of it a second later."""
    return bool(p.ap.arming.armed)


def servo(p: Aviator) -> int:
    return int(p.simulation.v.actuators.pwm[8])


def test_released_by_command(core: Core) -> None:
    p = packed(core, 20.0)
    assert servo(p) == 1100
    assert p.ask(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    released = p.texts[-1].time
    assert (said(p), turns(p)) == (["Parachute: Released", "Disarming motors"], False)
    pulses = []
    for _ in range(60):
        pulses.append((p.simulation.time_us * 1e-6 - released, servo(p)))
        p.fly(0.05)
    moved = [time for time, pulse in pulses if pulse == 1300]
    assert moved[0] == pytest.approx(0.5, abs=0.1), "half a second for the rotors to stop"
    assert moved[-1] == pytest.approx(2.5, abs=0.1)
    assert pulses[-1][1] == 1100
    p.fly(5.0)
    assert p.ask(400, 1) == FAILED
    assert p.said("Arm: Chute is released")


def test_neither_on_the_ground_nor_low(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", **CHUTE).ready()
    assert p.ask(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    p.arm()
    assert p.ask(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    assert said(p) == ["Parachute: Landed", "Parachute: Landed"]
    p.take_off(5.0)
    assert p.ask(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    assert turns(p) and said(p)[2:] == ["Parachute: Too low"]


def test_enabled_and_disabled(core: Core) -> None:
    p = packed(core, 15.0)
    assert p.ask(MavCmd.DO_PARACHUTE, DISABLE) == ACCEPTED
    assert p.ask(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    assert (turns(p), p.simulation.parameters["CHUTE_ENABLED"]) == (True, 0.0)
    assert p.ask(MavCmd.DO_PARACHUTE, 7) == FAILED
    assert p.ask(MavCmd.DO_PARACHUTE, ENABLE) == ACCEPTED
    assert p.simulation.parameters["CHUTE_ENABLED"] == 1.0
    assert p.ask(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    assert not turns(p)


def test_a_fall_out_of_control_releases_it(core: Core) -> None:
    """Two motors of one side stop: it turns over, falls, and 1 s later the parachute comes."""
    p = packed(core, 40.0)
    p.set_parameter("SIM_ENGINE_FAIL", 9)
    height = p.height
    assert p.fly(4.0, lambda: not turns(p))
    assert said(p)[0] == "Parachute: Released"
    assert 3.0 < height - p.height < 20.0


def test_a_flip_does_not_release_it(core: Core) -> None:
    p = packed(core, 40.0)
    assert p.set_mode(STABILIZE)
    p.sticks(0.5, throttle=1600)
    assert p.set_mode(FLIP)
    p.sticks(3.0, throttle=1600)
    assert turns(p) and said(p) == []


def test_sinking_too_fast_releases_it_after_a_second(core: Core) -> None:
    p = packed(core, 30.0, CHUTE_CRT_SINK=2.0)
    assert p.set_mode(STABILIZE)
    p.hold(throttle=1000)
    assert p.fly(2.0, lambda: p.vel[2] > 2.0)
    assert p.fly(2.0, lambda: not turns(p))
    assert said(p)[0] == "Parachute: Released"
    assert p.vel[2] == pytest.approx(2.0 + 9.0, abs=1.5)


def test_a_mission_releases_it(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", **CHUTE).ready()
    way = Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 15.0)
    p.start_mission(Item(MavCmd.NAV_TAKEOFF, None, 15.0), Item(MavCmd.DO_PARACHUTE, p=(2.0,)), way)
    p.wait_disarmed(40.0)
    assert p.said("Mission: 2 Parachute") and "Parachute: Released" in said(p)


def flying(b: Fitted) -> dict[str, Any]:
    """Lets the fake autopilot be in the air at 50 m."""
    answers: dict[str, Any] = {"landed": False, "error": 0.0, "height": 50.0, "sinks": 0.0, "released": []}
    b.autopilot.is_landed = lambda: answers["landed"]  # type: ignore[attr-defined]
    b.autopilot.height = lambda: answers["height"]  # type: ignore[attr-defined]
    b.autopilot.sink_rate = lambda: answers["sinks"]  # type: ignore[attr-defined]
    b.autopilot.lean_error = lambda: answers["error"]  # type: ignore[attr-defined]
    b.autopilot.release_parachute = answers["released"].append  # type: ignore[attr-defined]
    return answers


def test_switches() -> None:
    b = bench(**{**CHUTE, "CHUTE_ENABLED": 0.0})
    answers = flying(b)
    enabled = b.vehicle.parameters
    for function, position, value in ((21, HIGH, 1), (21, LOW, 0), (23, MIDDLE, 1), (23, LOW, 0)):
        b.bridge.switched(function, position)
        assert enabled["CHUTE_ENABLED"] == value
    b.bridge.switched(22, HIGH)
    assert answers["released"] == [], "not enabled"
    b.bridge.switched(23, HIGH)
    assert answers["released"] == [True]
    b.bridge.switched(22, HIGH)
    assert answers["released"] == [True], "once only"


def test_one_that_a_client_enables_is_there_at_once() -> None:
    b = bench(**{**CHUTE, "CHUTE_ENABLED": 0.0})
    answers = flying(b)
    b.autopilot.armed = lambda: True  # type: ignore[method-assign]
    answers["error"] = 1.0
    b.run(3.0)
    b.bridge.get(ParameterService).set("CHUTE_ENABLED", 1.0)
    b.run(0.15)
    answers["sinks"] = 10.0
    b.run(0.5)
    assert answers["released"] == []
    b.run(2.0)
    assert answers["released"] == [True]


@pytest.mark.parametrize(("begins", "ends", "released"), [(11.0, 5.0, [True]), (9.0, 5.0, [])])
def test_out_of_control_counts_when_it_begins_high_enough(begins: float, ends: float, released: list[bool]) -> None:
    """CHUTE_ALT_MIN 10; the real one, out of control from 30 m on with 27, releases at 23.6 m."""
    b = bench(**CHUTE)
    answers = flying(b)
    b.autopilot.armed = lambda: True  # type: ignore[method-assign]
    answers.update(height=begins, sinks=10.0, error=1.0)
    b.run(0.25)
    answers["height"] = ends
    b.run(2.0)
    assert answers["released"] == released


def test_sinking_too_fast_counts_when_it_is_still_high_enough(core: Core) -> None:
    """As with the real one: from 30 m with 27 it is not released, with 22 it is, at 23.7 m."""
    p = packed(core, 30.0, CHUTE_CRT_SINK=2.0, CHUTE_ALT_MIN=27.0)
    assert p.set_mode(STABILIZE)
    p.hold(throttle=1000)
    assert not p.fly(2.0, lambda: not turns(p)) and p.height < 22.0


def test_out_of_control_it_may_end_low(core: Core) -> None:
    p = packed(core, 30.0, CHUTE_ALT_MIN=27.0)
    p.set_parameter("SIM_ENGINE_FAIL", 9)
    assert p.fly(4.0, lambda: not turns(p)) and p.height < 26.0


def test_relay_held_open_with_the_motors_on() -> None:
    b = bench(
        CHUTE_ENABLED=1.0, CHUTE_TYPE=0.0, CHUTE_OPTIONS=3.0, CHUTE_DELAY_MS=1000.0, RELAY1_FUNCTION=1.0, RELAY1_PIN=9.0
    )
    answers = flying(b)
    assert b.command(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED
    assert answers["released"] == [False]
    state = b.bridge.get(ParachuteService).snapshot()
    b.run(30.0)
    assert b.bridge.get(ParachuteService).snapshot()[0][0] == 3, "done"
    b.bridge.get(ParachuteService).restore(state)
    assert b.bridge.get(ParachuteService).snapshot() == state


def test_a_rover_has_none() -> None:
    b = bench(FakeRover())
    assert b.command(MavCmd.DO_PARACHUTE, RELEASE) == UNSUPPORTED
    assert pulse(b) is None


OUT_OF_CONTROL = {"error": math.radians(30.5), "sinks": 4.0}


@pytest.mark.parametrize(
    ("answers", "released_s"),
    [
        (OUT_OF_CONTROL, 1.0), ({**OUT_OF_CONTROL, "error": math.radians(29.9)}, None),
        ({**OUT_OF_CONTROL, "sinks": 0.0}, None),
        ({**OUT_OF_CONTROL, "height": 10.0}, 1.0), ({**OUT_OF_CONTROL, "height": 9.99}, None),
        ({**OUT_OF_CONTROL, "landed": True}, None),
        ({"sinks": 5.01}, 1.1), ({"sinks": 5.0}, None), ({"sinks": 5.01, "height": 9.99}, None),
    ],
)  # fmt: skip
def test_a_fall_lasts_a_second_before_it_is_released(answers: Any, released_s: float | None) -> None:
    """Leaning 30 degrees more than it should and sinking, or sinking faster than CHUTE_CRT_SINK; not too low."""
    b = bench(**CHUTE, CHUTE_ALT_MIN=10.0, CHUTE_CRT_SINK=5.0)
    given = flying(b)
    given.update(answers)
    b.autopilot.armed = lambda: True  # type: ignore[method-assign]
    b.run((released_s or 20.0) - 0.0025)
    assert given["released"] == []
    b.run(0.0025)
    assert given["released"] == ([True] if released_s else [])


def test_a_vehicle_that_comes_back_under_control_begins_to_fall_anew() -> None:
    b = bench(**CHUTE)
    answers = flying(b)
    b.autopilot.armed = lambda: True  # type: ignore[method-assign]
    answers.update(OUT_OF_CONTROL)
    b.run(0.95)
    answers["error"] = 0.0
    b.run(1.0)
    answers["error"] = 1.0
    b.run(0.9)
    assert answers["released"] == []
    b.run(0.05)
    assert answers["released"] == [True]


def test_without_a_least_height_none_is_too_low() -> None:
    b = bench(**CHUTE, CHUTE_ALT_MIN=0.0)
    answers = flying(b)
    answers["height"] = -5.0
    assert b.command(MavCmd.DO_PARACHUTE, RELEASE) == ACCEPTED and answers["released"] == [True]


@pytest.mark.parametrize(("options", "stops", "closes"), [(0.0, True, True), (1.0, True, False), (2.0, False, True)])
def test_it_opens_after_its_delay_and_closes_after_two_seconds(options: float, stops: bool, closes: bool) -> None:
    """CHUTE_OPTIONS 1 holds it open, 2 leaves the motors on."""
    b = bench(**CHUTE, CHUTE_DELAY_MS=700.0, CHUTE_OPTIONS=options)
    answers = flying(b)
    b.run(3.0)
    assert (b.command(MavCmd.DO_PARACHUTE, RELEASE), answers["released"]) == (ACCEPTED, [stops])
    seen = []
    for seconds in (0.6975, 0.0025, 1.9975, 0.0025, 20.0):
        b.run(seconds)
        seen.append(pulse(b))
    assert seen == [1100, 1300, 1300, *[1100 if closes else 1300] * 2]


@pytest.mark.parametrize(("kind", "relay"), [(0.0, 0), (3.0, 3), (5.0, 5)])
def test_it_may_hang_on_a_relay(kind: float, relay: int) -> None:
    pins = {f"RELAY{relay + 1}_FUNCTION": 1.0, f"RELAY{relay + 1}_PIN": 9.0, "CHUTE_DELAY_MS": 0.0, "CHUTE_TYPE": kind}
    b = bench(**{**CHUTE, **pins})
    flying(b)
    masks = [b.vehicle.parameters["SIM_PIN_MASK"]]
    b.command(MavCmd.DO_PARACHUTE, RELEASE)
    for seconds in (0.01, 2.5):
        b.run(seconds)
        masks.append(b.vehicle.parameters["SIM_PIN_MASK"])
    assert masks == [0.0, 512.0, 0.0] and pulse(b) is None
