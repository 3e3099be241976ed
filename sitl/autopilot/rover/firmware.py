# SPDX-License-Identifier: BSD-3-Clause
"""The rover firmware: its main loop, and what the shell needs to know of it."""

from __future__ import annotations

from ...core.kernels import inlined
from ...core.records import Records
from ..estimation.update import update as estimate
from ..firmware import Firmware
from ..landing_target import estimator as landing_target
from .aux_functions import FUNCTIONS as AUX_FUNCTIONS
from .control.control_step import init as init_control
from .control.control_step import update as control
from .event_list import EVENTS
from .mission import COMMANDS
from .modes.decisions import init as init_modes
from .modes.decisions import update as decide
from .modes.mode_list import NAMES
from .parameters import TABLE
from .state import Vehicle

PERIOD_TICKS = 8
"""Modes and control run at 50 Hz (SCHED_LOOP_RATE), the estimator at every tick of 400 Hz."""


@inlined
def update(fleet: Records[Vehicle], index: int) -> None:
    """One tick of vehicle ``index``, from ``sensors`` to ``actuators``; 400 times a simulated second."""
    estimate(fleet, index)
    if fleet[index].tick % PERIOD_TICKS == 0:
        decide(fleet, index)
        control(fleet, index)
    if fleet[index].autopilot.params.PLND.ENABLED != 0.0 or fleet[index].autopilot.landing_target.running:
        landing_target.estimate(fleet[index], int(fleet[index].autopilot.params.PLND.ORIENT))


def power_on(v: Vehicle) -> None:
    """Start the parts of the firmware on a cleared record whose parameters are set."""
    init_control(v.autopilot.control, v.autopilot.params)
    init_modes(v)


FIRMWARE = Firmware("rover", TABLE, NAMES, power_on, COMMANDS, AUX_FUNCTIONS, events=EVENTS)
