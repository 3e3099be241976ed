# SPDX-License-Identifier: BSD-3-Clause
"""Horizontal and vertical position together: straight to a point, as GUIDED flies it."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import finite
from ...control.shaping import kinematic_limit
from .altitude import advance_d, input_vel_accel_d, shape_pos_d
from .position import advance_ne, input_vel_accel_ne, shape_pos_ne


@law
def input_pos_ned(ap, pn, pe, pd):
    """Go to the point (pn, pe, pd) [m] in a straight line: speed limits of both cascades hold along it."""
    if not finite(pn + pe + pd):
        input_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0)
        input_vel_accel_d(ap, 0.0, 0.0)
        return
    advance_ne(ap)
    advance_d(ap)
    ne, d = ap.control.pos_ne, ap.control.pos_d
    dn, de, dd = pn - float(ne.pos_desired[0]), pe - float(ne.pos_desired[1]), pd - float(d.pos_desired)
    length = math.sqrt(dn * dn + de * de + dd * dd)
    speed_ne, speed_d = 0.0, 0.0
    if length > 1e-9:
        dn, de, dd = dn / length, de / length, dd / length
        most = kinematic_limit(dn, de, dd, float(ne.speed_max), float(d.speed_up), float(d.speed_down))
        speed_ne = most * math.sqrt(dn * dn + de * de)
        speed_d = most * abs(dd)
    shape_pos_ne(ap, pn, pe, 0.0, 0.0, 0.0, 0.0, speed_ne, 0)
    shape_pos_d(ap, pd, 0.0, 0.0, speed_d, speed_d)
