# SPDX-License-Identifier: BSD-3-Clause
"""PID_TUNING: a message for each loop that a bit of GCS_PID_MASK names."""

from __future__ import annotations

from ...autopilot.control.pid import Gains, Pid
from ...core.kernels import law
from ..wire.message import Message
from ..wire.port import Port

ROLL, PITCH, YAW_LOOP, VERTICAL, STEERING = 1, 2, 3, 4, 5
"""PID_TUNING_AXIS; a rover's speed loop is sent as VERTICAL (ACCZ)."""


class PidTuning(Message, name="PID_TUNING"):
    axis: int
    desired: float
    achieved: float
    FF: float
    P: float
    I: float  # noqa: E741 - the dialect's name
    D: float
    SRate: float
    PDmod: float


@law
def next_loop(port: Port, loops: int, mask: float) -> int:
    """Number of the loop whose turn it is, -1 when its bit is not set; the next of ``loops`` comes then."""
    loop = port.part
    port.part = loop + 1 if loop + 1 < loops else 0
    return loop if int(mask) >> loop & 1 else -1


@law
def fill_tuning(m: PidTuning, axis: int, pid: Pid, achieved: float, gains: Gains, scale: float) -> None:
    """A loop: target and measurement in its own unit, parts of the output times ``scale``."""
    m.axis = axis
    m.desired = pid.target
    m.achieved = achieved
    m.FF = scale * pid.target * gains.ff
    m.P = scale * pid.error * gains.p
    m.I = scale * pid.integrator
    m.D = scale * pid.derivative * gains.d
    m.PDmod = 1.0
