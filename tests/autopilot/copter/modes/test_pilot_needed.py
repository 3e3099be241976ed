# SPDX-License-Identifier: BSD-3-Clause
"""In radio failsafe nobody enters a mode that only a pilot flies, whatever the way."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter import failsafe
from sitl.autopilot.copter.modes import mode_list, set_mode
from sitl.autopilot.copter.modes.acro import ACRO
from sitl.autopilot.copter.modes.alt_hold import ALT_HOLD
from sitl.autopilot.copter.modes.drift import DRIFT
from sitl.autopilot.copter.modes.guided import GUIDED
from sitl.autopilot.copter.modes.land import LAND
from sitl.autopilot.copter.modes.loiter import LOITER
from sitl.autopilot.copter.modes.stabilize import STABILIZE
from sitl.autopilot.copter.modes.turtle import TURTLE
from sitl.autopilot.modes import ModeReason, ModeResult
from tests.autopilot.copter.steady_copter import fly

REASONS = list(ModeReason)
NEED_PILOT = (STABILIZE, ACRO, DRIFT, TURTLE)


def test_the_table_of_modes_says_which() -> None:
    assert sorted(mode_list.NEED_PILOT) == sorted(NEED_PILOT)


@pytest.mark.parametrize("number", NEED_PILOT)
@pytest.mark.parametrize("armed", (False, True))
def test_they_are_refused_for_every_reason(vehicle, number, armed) -> None:
    ap = fly(vehicle, GUIDED).autopilot if armed else vehicle.autopilot
    ap.modes.number = GUIDED
    ap.modes.failsafe.radio = True
    for reason in REASONS:
        assert set_mode.request(vehicle, number, reason) == ModeResult.NO_RADIO
        assert ap.modes.number == GUIDED
    assert set_mode.refusal_texts(STABILIZE, ModeResult.NO_RADIO) == ["Mode change to STABILIZE failed: in RC failsafe"]


@pytest.mark.parametrize("number", (ALT_HOLD, LOITER, LAND))
def test_the_others_are_not(flying, number) -> None:
    flying.autopilot.modes.failsafe.radio = True
    assert set_mode.request(flying, number, ModeReason.GCS) == ModeResult.ACCEPTED


def test_with_a_radio_they_are_entered(flying) -> None:
    for number in (STABILIZE, ACRO, DRIFT):
        assert set_mode.request(flying, number, ModeReason.GCS) == ModeResult.ACCEPTED


@pytest.mark.parametrize(("radio_lost", "mode"), ((False, ALT_HOLD), (True, LAND)))
def test_a_bad_estimate_does_not_leave_the_vehicle_to_a_pilot_who_is_gone(flying, radio_lost, mode) -> None:
    ap = flying.autopilot
    ap.modes.number = LOITER
    ap.params.FS_EKF_ACTION = 2.0
    ap.modes.failsafe.radio = radio_lost
    failsafe.act_on_estimate(flying)
    assert ap.modes.number == mode
