# SPDX-License-Identifier: BSD-3-Clause
"""THROW: thrown by a shove of the simulated world. Values are a real ArduPilot's, thrown in the same way."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import GUIDED, LAND, LOITER, RTL, THROW, Aviator
from tests.pilots.witness import LOW


def armed(core: Core, **params: float) -> Aviator:
    """Armed in THROW on the ground, throttle low."""
    p = Aviator(core, "ardupilot_quad", **params)
    p.boot()
    assert p.set_mode(THROW)
    p.sticks(0.5, throttle=LOW)
    p.arm(3.0)
    assert p.said("waiting for throw")
    return p


def throw(p: Aviator, forward: float = -20.0, down: float = -30.0, milliseconds: float = 500.0) -> float:
    """Shove it; the time."""
    p.set_parameter("SIM_SHOVE_X", forward)
    p.set_parameter("SIM_SHOVE_Z", down)
    start = p.now
    p.send("PARAM_SET", param_id=b"SIM_SHOVE_TIME", param_value=milliseconds, param_type=9)  # soon 0 again
    return start


def when(p: Aviator, text: str, start: float) -> float:
    """How long after ``start`` a text was said [s]."""
    return next(time for time, _, said in p.texts if text in said) - start


def test_thrown_up_it_starts_its_motors_climbs_on_and_stops(core: Core) -> None:
    p = armed(core)
    start = throw(p)
    p.fly(12.0)
    assert p.mode == THROW
    thrown = p.since(start)
    assert 8.0 < -thrown[:, 4].min() < 10.0 and 8.0 < -thrown[:, 6].min() < 10.2, "the shove, less drag and weight"
    assert when(p, "throw detected", start) == pytest.approx(0.8, abs=0.25)
    assert when(p, "uprighting", start) == pytest.approx(1.3, abs=0.4)
    assert when(p, "height achieved", start) == pytest.approx(2.6, abs=0.7)
    assert p.height == pytest.approx(9.5, abs=1.7), "stops between 8.8 and 10 m"
    assert float(np.linalg.norm(p.vel)) < 0.2
    place = p.pos.copy()
    p.sticks(3.0, roll=1800, throttle=1800)
    assert float(np.linalg.norm(p.pos - place)) < 0.5, "the sticks do nothing"
    assert p.set_mode(LOITER) and not p.set_mode(THROW)


def test_waits_for_ever_and_may_be_disarmed(core: Core) -> None:
    p = armed(core)
    p.fly(15.0)
    assert p.ap.arming.armed and p.on_ground, "no DISARM_DELAY"
    assert p.simulation.v.actuators.controls[0] == 0.0, "motors stand"
    assert p.ask(400, 0) == 0


def test_motors_may_idle_before_the_throw(core: Core) -> None:
    p = armed(core, THROW_MOT_START=1.0)
    p.fly(2.0)
    assert p.simulation.v.actuators.controls[0] == pytest.approx(0.1) and p.on_ground
    start = throw(p)
    p.fly(5.0)
    assert when(p, "uprighting", start) < 1.2


@pytest.mark.parametrize("mode", (RTL, LAND, GUIDED))
def test_then_another_mode(core: Core, mode: int) -> None:
    p = armed(core, THROW_NEXTMODE=float(mode))
    throw(p)
    assert p.fly(8.0, lambda: p.mode == mode)
    if mode == GUIDED:
        p.fly(8.0)
        assert float(np.linalg.norm(p.vel)) < 0.3
    else:
        p.wait_disarmed(90.0)


@pytest.mark.parametrize(("limit", "value"), (("THROW_ALT_MIN", 20.0), ("THROW_TYPE", 1.0)))
def test_what_is_no_throw_by_the_parameters(core: Core, limit: str, value: float) -> None:
    p = armed(core, **{limit: value})
    throw(p, 0.0, -20.0, 200.0)
    p.fly(0.7)
    assert not p.said("throw detected")


def test_dropped_it_stops_below(core: Core) -> None:
    p = armed(core, THROW_TYPE=1.0)
    start = throw(p, 0.0, -40.0, 800.0)
    assert p.fly(8.0, lambda: p.said("height achieved"))
    top = -p.since(start)[:, 3].min()
    p.fly(6.0)
    assert 2.0 < p.height < top - 1.0 and float(np.linalg.norm(p.vel)) < 0.3
