# SPDX-License-Identifier: BSD-3-Clause
"""What the simulation reports of hits; ``a``: the speed [m/s]."""

from __future__ import annotations

from ..core.mavlink import MavSeverity
from .events import Event

HIT_GROUND = Event(17, MavSeverity.INFO, "SIM Hit ground at {a:f} m/s")
HIT_OBSTACLE = Event(28, MavSeverity.INFO, "SIM Hit obstacle at {a:f} m/s")
