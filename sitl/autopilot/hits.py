# SPDX-License-Identifier: BSD-3-Clause
"""What the simulation tells of hits; ``a``: the speed [m/s]."""

from __future__ import annotations

from .events import Event
from .notes import INFO

HIT_GROUND = Event(17, INFO, "SIM Hit ground at {a:f} m/s")
HIT_OBSTACLE = Event(28, INFO, "SIM Hit obstacle at {a:f} m/s")
