# SPDX-License-Identifier: BSD-3-Clause
"""A ground vehicle as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .airframe import Airframe
from .figures.figure import figures
from .figures.rover import MODEL, Figures


@dataclass(frozen=True, kw_only=True)
class RoverAirframe(Airframe):
    """A rover: ``figures.rover``."""

    kind: ClassVar[str] = "rover"
    known = figures(Figures)
    dtype = Figures.dtype
    model = MODEL
