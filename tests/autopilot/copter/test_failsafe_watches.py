# SPDX-License-Identifier: BSD-3-Clause
"""What a copter's failsafes watch ten times a second: the estimate, fixes, vibration, heights of the ground."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.copter import failsafe
from sitl.autopilot.copter.control import vibration_compensation
from sitl.autopilot.failsafe_checks import FAILSAFE, GLITCH, TERRAIN, VIBRATION
from sitl.autopilot.terrain.state import FAILSAFE as GROUND_MISSING
from sitl.autopilot.terrain.state import RTL_BEGINS_ANEW, TERRAIN_DID
from tests.autopilot.copter.steady_copter import told, wait

GPS_GLITCHING = 32768  # EKF_STATUS_FLAGS


@pytest.mark.parametrize(
    ("threshold", "armed", "located", "watched"),
    ((0.8, 1, 1, True), (0.0, 1, 1, False), (-1.0, 1, 1, False), (0.8, 0, 1, False), (0.8, 1, 0, False)),
)
def test_the_estimate_is_watched_armed_and_with_a_place(flying, threshold, armed, located, watched, monkeypatch):
    ap = flying.autopilot
    monkeypatch.setattr(failsafe, "is_estimate_bad", lambda *args: True)
    ap.params.FS.EKF_THRESH, ap.arming.armed, ap.estimate.origin_set = threshold, armed, located
    ap.modes.failsafe.ekf_count = 3
    failsafe.watch_estimate(flying)
    assert ap.modes.failsafe.ekf_count == (4 if watched else 0)


def test_a_glitch_is_told_when_it_begins_and_ends(flying: Any) -> None:
    est = flying.autopilot.estimate
    for flags in (0, GPS_GLITCHING | 1, GPS_GLITCHING, 1, 0):
        est.status_flags = flags
        failsafe.watch_glitch(flying)
    assert told(flying, FAILSAFE) == [(float(GLITCH), 1.0), (float(GLITCH), 0.0)]


@pytest.mark.parametrize(("armed", "enabled", "watched"), ((1, 1.0, True), (0, 1.0, False), (1, 0.0, False)))
def test_vibration_is_watched_armed_and_when_enabled(flying, armed, enabled, watched, monkeypatch):
    ap = flying.autopilot
    ap.arming.armed, ap.params.FS.VIBE_ENABLE = armed, enabled
    seen: list[bool] = []
    changes = [vibration_compensation.BEGINS, vibration_compensation.NOTHING, vibration_compensation.ENDS]

    def watch(state: Any, est: Any, is_watched: bool, time_us: int) -> int:
        seen.append(bool(is_watched))
        return changes[len(seen) - 1]

    monkeypatch.setattr(vibration_compensation, "watch", watch)
    for _ in changes:
        failsafe.watch_vibration(flying)
    assert seen == [watched] * 3
    assert told(flying, FAILSAFE) == [(float(VIBRATION), 1.0), (float(VIBRATION), 0.0)]


def without_ground(v: Any, mode: int) -> None:
    """The height of the ground has been missing for a long time, and is now."""
    t = v.autopilot.terrain
    v.autopilot.modes.number = mode
    t.missing_us = v.time_us
    wait(v, 30.0)
    t.missed_us = v.time_us
    failsafe.watch_terrain(v)


@pytest.mark.parametrize(("mode", "after"), ((4, 6), (6, 6)))
def test_a_missing_height_of_the_ground_ends_in_rtl(flying: Any, mode: int, after: int) -> None:
    without_ground(flying, mode)
    modes = flying.autopilot.modes
    assert modes.number == after
    assert (float(TERRAIN), 1.0) in told(flying, FAILSAFE)
    said = [int(a) for a, _ in told(flying, TERRAIN_DID)]
    assert said == [GROUND_MISSING] + [RTL_BEGINS_ANEW] * (mode == 6)
    assert flying.autopilot.terrain.missed_us == 0
    failsafe.watch_terrain(flying)  # once
    assert len(told(flying, TERRAIN_DID)) == len(said)


def test_on_its_way_home_over_the_ground_it_begins_anew_at_heights_above_home(flying: Any) -> None:
    ap = flying.autopilot
    ap.home.is_set, ap.params.RTL.ALT, ap.params.RTL.ALT_TYPE, ap.params.RTL.CONE_SLOPE = 1, 1500.0, 1.0, 0.0
    ap.modes.nav.over_ground, ap.modes.rtl.state, ap.modes.rtl.return_d = 1, 3, -99.0
    without_ground(flying, 6)
    assert (ap.modes.nav.over_ground, ap.modes.rtl.state) == (0, 1)
    assert ap.modes.rtl.return_d == pytest.approx(-15.0)


def test_without_a_home_it_lands_and_on_the_ground_it_disarms(flying: Any) -> None:
    ap = flying.autopilot
    ap.home.is_set = 0
    without_ground(flying, 4)
    assert (ap.modes.number, bool(ap.modes.land.pause)) == (9, True)
    ap.arming.landed = 1
    without_ground(flying, 4)
    assert not ap.arming.armed


def test_a_height_that_is_missing_for_a_moment_is_borne(flying: Any) -> None:
    t = flying.autopilot.terrain
    t.missing_us = t.missed_us = flying.time_us
    failsafe.watch_terrain(flying)
    assert told(flying, FAILSAFE) == [] and flying.autopilot.modes.number == 4


def test_termination_stops_the_motors_at_once(flying: Any) -> None:
    failsafe.terminate(flying)
    arming = flying.autopilot.arming
    assert not arming.armed and arming.landed
    assert flying.autopilot.control.motors.desired_spool == 0
