# SPDX-License-Identifier: BSD-3-Clause
"""What the controllers need once, at boot (gains are read live from the parameters)."""

from __future__ import annotations

from ....core.kernels import law
from . import position
from .speed import decel_max
from .steering import lat_accel_max


@law
def init(ap):
    """Limits of the position controller to sane starts; harmless when called again."""
    if ap.control.position.speed_max <= 0.0:
        accel = decel_max(ap)
        position.set_limits(ap, float(ap.params.CRUISE.SPEED), accel, lat_accel_max(ap), accel)
