# SPDX-License-Identifier: BSD-3-Clause
"""Where robots really are: what no sensor tells and no MAVLink message carries."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from sitl.core.algebra import euler_of
from sitl.core.array_kernels import Kernel, Layout, Table
from sitl.core.elementary import sincos
from sitl.core.kernels import law
from sitl.core.records import FloatRows, Floats
from sitl.core.vectors import Quat
from sitl.worlds.shapes import from_heading, from_ned

FieldTable = Annotated[FloatRows, Layout("f8", 2, "A")]
"""Floats, shape (m, n), a vector field of every record of a fleet."""
FieldLine = Annotated[Floats, Layout("f8", 1, "A")]
"""Floats, shape (m,), a field of every record of a fleet."""
STATE, TRUE_REPORT = 12, 9
"""Columns of a state: see ``RobotArrays.state``; of ``write_true_reports``."""


@law
def write_truth(pos: FieldTable, vel: FieldTable, q: FieldTable, rates: FieldTable, ahead: float, out: Table) -> None:
    """Write the true states of bodies in the frames of environments.

    Args:
        pos: NED in the world [m], shape (count, 3).
        vel: NED [m/s], shape (count, 3).
        q: body to NED, shape (count, 4).
        rates: of the bodies, FRD [rad/s], shape (count, 3).
        ahead: how far the robot's base lies ahead of the body's origin [m].
        out: x, y, z [m], yaw [rad]; forward, left, up [m/s], turn rate [rad/s]; roll to the right, pitch up [rad],
            their rates [rad/s]; shape (count, 12).
    """
    for i in range(out.shape[0]):
        angles = euler_of(Quat(q[i, 0], q[i, 1], q[i, 2], q[i, 3]))
        s, c = sincos(angles.yaw)
        x, y, z = from_ned(pos[i, 0] + ahead * c, pos[i, 1] + ahead * s, pos[i, 2])
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = x, y, z, from_heading(angles.yaw)
        out[i, 4], out[i, 5] = vel[i, 0] * c + vel[i, 1] * s, vel[i, 0] * s - vel[i, 1] * c
        out[i, 6], out[i, 7] = 0.0 - vel[i, 2], 0.0 - rates[i, 2]
        out[i, 8], out[i, 9] = angles.roll, angles.pitch
        out[i, 10], out[i, 11] = rates[i, 0], rates[i, 1]


_write = Kernel(write_truth)


def truth_writer(bodies: Any) -> Callable[[float, npt.NDArray[np.float64]], None]:
    """``true_states`` of bodies that stay in place, quick to call."""
    return _write.bind(bodies["pos"], bodies["vel"], bodies["q"], bodies["rates"])


def true_states(bodies: Any, ahead: float, out: npt.NDArray[np.float64]) -> None:
    """Write the true states of bodies (``sitl.physics.native.records.Body``, an array) into ``out``, shape (count, 12):
    see ``write_truth``."""
    _write(bodies["pos"], bodies["vel"], bodies["q"], bodies["rates"], ahead, out)


@law
def write_true_reports(
    force: FieldTable, wind: FieldTable, q: FieldTable, voltage: FieldLine, current: FieldLine, charge: FieldLine,
    out: Table,
) -> None:  # fmt: skip
    """Write what vehicles would measure without errors.

    Args:
        force: specific force on the body, FRD [m/s^2], shape (count, 3).
        wind: NED [m/s], shape (count, 3).
        q: body to NED, shape (count, 4).
        voltage, current: of the batteries [V], [A], shape (count,).
        charge: that is left [0, 1], shape (count,).
        out: specific force forward, left, up of the body [m/s^2]; voltage, current, charge; where the wind blows to,
            forward, left of the heading, and up [m/s]; shape (count, 9).
    """
    for i in range(out.shape[0]):
        yaw = euler_of(Quat(q[i, 0], q[i, 1], q[i, 2], q[i, 3])).yaw
        s, c = sincos(yaw)
        out[i, 0], out[i, 1], out[i, 2] = force[i, 0], 0.0 - force[i, 1], 0.0 - force[i, 2]
        out[i, 3], out[i, 4], out[i, 5] = voltage[i], current[i], charge[i]
        out[i, 6], out[i, 7] = wind[i, 0] * c + wind[i, 1] * s, wind[i, 0] * s - wind[i, 1] * c
        out[i, 8] = 0.0 - wind[i, 2]


_write_reports = Kernel(write_true_reports)


def true_reports(physics: Any, out: npt.NDArray[np.float64]) -> None:
    """Write what vehicles would measure without errors into ``out``, shape (count, 9): see ``write_true_reports``.

    Args:
        physics: records (``sitl.physics.native.records.Physics``), an array.
        out: shape (count, 9).
    """
    body, battery = physics["body"], physics["battery"]
    _write_reports(
        body["specific_force"], physics["wind"]["vel"], body["q"], battery["voltage"], battery["current"],
        battery["charge"], out,
    )  # fmt: skip
