# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot's main loop: estimate, decide, control and mix. 400 times a simulated second."""

from __future__ import annotations

from ..core.kernels import law
from .control.update import update as control
from .estimation.update import update as estimate
from .modes.copter.update import update as decide


@law
def update(fleet, index):
    """One tick: from ``sensors`` to ``actuators`` of vehicle ``index``."""
    estimate(fleet, index)
    decide(fleet, index)
    control(fleet, index)
