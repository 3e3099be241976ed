# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED_NOGPS: flies attitudes of a companion computer (SET_ATTITUDE_TARGET), without a position."""

from __future__ import annotations

from ....core.kernels import law
from ...modes import ModeResult
from ..state import Vehicle
from . import guided
from .guided import GUIDED_NOGPS
from .mode import CopterMode


@law
def start(v: Vehicle) -> int:
    """Enter: level, at constant height, until an attitude comes."""
    ap = v.autopilot
    state = ap.modes.guided
    guided.start_submode(state, guided.ANGLE, ap.control, ap.estimate, ap.params)
    state.use_attitude = False
    state.use_thrust = False
    guided.level_off(state, ap.control, ap.estimate, ap.params)
    state.update_us = v.time_us
    return ModeResult.ACCEPTED


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    state, p = ap.modes.guided, ap.params
    stale = guided.is_stale(state, v.time_us, p.GUID.TIMEOUT)
    guided.note_timeout(state, stale, ap.events, v.time_us)
    guided.run_angle(state, stale, ap.arming, ap.control, ap.estimate, p)


MODE = CopterMode(
    number=GUIDED_NOGPS,
    name="GUIDED_NOGPS",
    start=start,
    run=run,
    autonomous=True,
    arms_at_any_throttle=True,
    may_arm=guided.may_arm,
)
