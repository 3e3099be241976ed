# SPDX-License-Identifier: BSD-3-Clause
"""A client sets parameters to anything that PARAM_SET takes: no flight along a leg raises, and legs stay finite."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from benchmarks.recorded.pilot import ARM, POSITION_ONLY, VELOCITY_ONLY
from sitl.autopilot.params.parameter import FLOAT, Parameter
from sitl.core.mavlink import MavCmd
from sitl.simulation import load_core
from sitl.vehicle.kinds import KINDS
from tests.pilots.witness import Item, Witness

FRAMES = {"copter": "erle_copter", "rover": "ardupilot_rover"}
AUTO, GUIDED, RTL = {"copter": 3, "rover": 10}, {"copter": 4, "rover": 15}, {"copter": 6, "rover": 11}
GROUPS = ("WPNAV_", "WP_", "ATC_", "PSC_", "RTL_", "TURN_", "CRUISE_", "SPEED_", "LOIT_")
"""Parameters that legs are planned and followed by."""
CHANGE_SPEED = 178


@cache
def _moving(kind: str) -> tuple[Witness, Any]:
    """A vehicle that moves north in GUIDED with a mission aboard, and its snapshot."""
    p = Witness(load_core(KINDS[kind]), FRAMES[kind])
    p.boot()
    places = (
        Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 12.0),
        Item(MavCmd.NAV_WAYPOINT, (20.0, 20.0), 12.0),
        Item(MavCmd.NAV_WAYPOINT, (0.0, 20.0), 12.0),
    )
    assert p.upload(*([Item(MavCmd.NAV_TAKEOFF, None, 10.0)] if kind == "copter" else []), *places) == 0
    assert p.ask(ARM, 1, wait=2.0) == 0, p.texts
    if kind == "copter":
        assert p.ask(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 5.0) == 0
        p.fly(8.0)
    p.stream(3.0, VELOCITY_ONLY, vx=2.0)
    assert p.vel[0] > 1.0
    return p, p.simulation.snapshot()


def _values(parameter: Parameter) -> st.SearchStrategy[float]:
    low, high = parameter.low, parameter.high
    if parameter.kind != FLOAT:
        return st.one_of(st.just(low), st.just(high), st.integers(int(low), int(high)).map(float))
    tiny = [value for value in (1e-45, 1e-30, 1e-15, 1e-6, -1e-30) if low <= value <= high]
    return st.one_of(st.sampled_from([low, high, *tiny]), st.floats(low, high))


def _settings(kind: str) -> st.SearchStrategy[dict[str, float]]:
    ours = [p for p in KINDS[kind].firmware.table.with_effect if p.name.startswith(GROUPS) and not p.read_only]
    one = st.sampled_from(ours).flatmap(lambda p: st.tuples(st.just(p.name), _values(p)))
    return st.lists(one, min_size=1, max_size=8).map(dict)


def _fly(kind: str, values: dict[str, float], speed: float) -> None:
    p, start = _moving(kind)
    p.simulation.advance(0.0)
    p.connection.endpoint.receive()
    p.simulation.restore(start)
    for name, value in values.items():
        p.send(
            "PARAM_SET", param_id=name.encode(), param_value=value, param_type=9
        )  # fmt: skip
    p.send_command(CHANGE_SPEED, 1, speed, -1)
    p.fly(0.1)
    for act in ("rtl", "guided", "auto", "rtl"):
        if act == "guided":
            assert p.set_mode(GUIDED[kind])
            p.setpoint(POSITION_ONLY, (30.0, -20.0, -8.0))
        else:
            assert p.set_mode((RTL if act == "rtl" else AUTO)[kind]), p.texts[-3:]
        p.fly(1.0)
        nav = p.ap.modes.nav
        for leg in (nav.current, nav.next):
            if leg.segments > 0:
                times = [leg.duration, leg.length, *leg.origin, *leg.t[: leg.segments], *leg.v[: leg.segments]]
                assert np.isfinite(times).all(), (act, times)


@pytest.mark.parametrize("name", ["ATC_DECEL_MAX", "WP_ACCEL", "WP_JERK", "ATC_ACCEL_MAX"])
def test_a_rover_returns_with_almost_no_limit(name: str) -> None:
    """One positive number next to nothing is a limit, but none that stops the program."""
    _fly("rover", {name: 1e-15}, -1.0)


@pytest.mark.parametrize("name", ["ATC_RATE_R_MAX", "ATC_ACCEL_R_MAX", "ATC_INPUT_TC", "WPNAV_ACCEL_C"])
def test_a_copter_returns_with_almost_no_limit(name: str) -> None:
    """The same in the air."""
    _fly("copter", {name: 1e-30}, -1.0)


SPEEDS = st.sampled_from([-1.0, 1e-30, 1e-3, 1.0, 1e9])


@given(_settings("rover"), SPEEDS)
@example({"ATC_DECEL_MAX": 1e-15}, -1.0)
@settings(max_examples=25)
def test_any_rover(values: dict[str, float], speed: float) -> None:
    """Any values together."""
    _fly("rover", values, speed)


@given(_settings("copter"), SPEEDS)
@example({"ATC_RATE_P_MAX": 1e-30, "ATC_ACCEL_R_MAX": 1e-30}, 1e-30)
@settings(max_examples=25)
def test_any_copter(values: dict[str, float], speed: float) -> None:
    """Any values together."""
    _fly("copter", values, speed)
