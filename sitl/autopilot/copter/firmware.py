# SPDX-License-Identifier: BSD-3-Clause
"""The copter firmware: its main loop, and what the shell needs to know of it."""

from __future__ import annotations

from ...core.kernels import inlined
from ...core.records import Records
from ..estimation.update import update as estimate
from ..firmware import Firmware
from ..landing_target import estimator as landing_target
from ..landing_target.orientation import DOWN
from .aux_functions import FUNCTIONS as AUX_FUNCTIONS
from .control.control_step import init as init_control
from .control.control_step import update as control
from .control.frames import load_frame
from .event_list import EVENTS
from .mission import COMMANDS
from .modes.autotune_gains import give_back
from .modes.decisions import init as init_modes
from .modes.decisions import update as decide
from .modes.mode_list import NAMES
from .parameters import TABLE
from .state import Vehicle


@inlined
def update(fleet: Records[Vehicle], index: int) -> None:
    """One tick of vehicle ``index``, from ``sensors`` to ``actuators``; 400 times a simulated second."""
    estimate(fleet, index)
    decide(fleet, index)
    control(fleet, index)
    if fleet[index].autopilot.params.PLND.ENABLED != 0.0 or fleet[index].autopilot.landing_target.running:
        landing_target.estimate(fleet[index], DOWN)


def power_on(v: Vehicle) -> None:
    """Start the parts of the firmware on a cleared record whose parameters are set."""
    load_frame(v.autopilot.control.motors, v.autopilot.params)
    init_control(v.autopilot.control, v.autopilot.estimate, v.autopilot.params)
    init_modes(v)


FIRMWARE = Firmware(
    "copter",
    TABLE,
    NAMES,
    power_on,
    COMMANDS,
    AUX_FUNCTIONS,
    give_back,
    fence_bytes=560,
    rally_bytes=690,
    events=EVENTS,
)
