# SPDX-License-Identifier: BSD-3-Clause
"""SURF: the surface below as the rangefinder sees it."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import bits
from .formats import Field, Message
from .samples import Array

_COUNT, _HEIGHT = "sensors.rangefinder_count", "autopilot.estimate.pos[2]"
_ENABLED, _UNHEALTHY = 1, 2
"""Bits of St."""


def _is_seen(s: Any) -> Array:
    return (s.raw(_COUNT) > 0) & np.isfinite(s("sensors.rangefinder_range[0]"))


def _status(s: Any) -> Array:
    return np.where(s.raw(_COUNT) > 0, _ENABLED, 0) | np.where(_is_seen(s), 0, _UNHEALTHY)


def _distance(s: Any) -> Array:
    """Straight down [m]; 0: nothing is seen."""
    found = np.where(_is_seen(s), s("sensors.rangefinder_range[0]"), 0.0)
    return np.asarray(found * s("autopilot.control.attitude.cos_lean"))


def _offset(s: Any) -> Array:
    """Height of the surface above the origin [m]."""
    return np.asarray(-s(_HEIGHT) - _distance(s))


MESSAGE = Message("SURF", bits.MEDIUM, bits.CONTROL).of(
    Field("I", "B", "#"),
    Field("St", "B", source=_status),
    Field("D", "f", "m", "0", _distance),
    Field("FD", "f", "m", "0", _distance),
    Field("TO", "f", "m", "0", _offset),
)
"""One down; a second one, upwards, is of no vehicle here."""
