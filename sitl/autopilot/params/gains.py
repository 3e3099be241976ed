# SPDX-License-Identifier: BSD-3-Clause
"""Gains of the PIDs of all firmwares."""

from __future__ import annotations

from .parameter import ParameterGroup, param


class PidGains(ParameterGroup):
    """A loop with filters on target, error and derivative (ArduPilot's AC_PID)."""

    P: float = param(0.135, 0.0, 5.0, "", "proportional gain")
    I: float = param(0.135, 0.0, 10.0, "", "integral gain")  # noqa: E741
    D: float = param(0.0036, 0.0, 1.0, "", "derivative gain")
    FF: float = param(0.0, 0.0, 5.0, "", "feed-forward of the target")
    IMAX: float = param(0.5, 0.0, 1.0, "", "limit of the integrator")
    FLTT: float = param(20.0, 0.0, 400.0, "Hz", "low-pass of the target; 0: none")
    FLTE: float = param(0.0, 0.0, 400.0, "Hz", "low-pass of the error; 0: none")
    FLTD: float = param(20.0, 0.0, 400.0, "Hz", "low-pass of the derivative; 0: none")
    PDMX: float = param(0.0, 0.0, 1.0, "", "limit of P and D together; 0: none")
    D_FF: float = param(0.0, 0.0, 1.0, "", "feed-forward of the target's rate")


class BasicPidGains(ParameterGroup):
    """A loop with filters on error and derivative (ArduPilot's AC_PID_Basic and AC_PID_2D)."""

    P: float = param(2.0, 0.0, 20.0, "1/s", "Acceleration asked for per speed error")
    I: float = param(1.0, 0.0, 20.0, "", "integral gain")  # noqa: E741
    IMAX: float = param(1000.0, 0.0, 10000.0, "cm/s/s", "limit of the integrator")
    FLTE: float = param(5.0, 0.0, 400.0, "Hz", "low-pass of the error; 0: none")
    D: float = param(0.25, 0.0, 10.0, "", "derivative gain")
    FLTD: float = param(5.0, 0.0, 400.0, "Hz", "low-pass of the derivative; 0: none")
    FF: float = param(0.0, 0.0, 10.0, "", "feed-forward of the target")
