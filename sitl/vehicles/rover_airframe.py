# SPDX-License-Identifier: BSD-3-Clause
"""A ground vehicle as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ..deprecation import renamed
from .airframe import Airframe
from .properties.ground_vehicle import MODEL, Properties
from .properties.property import properties


@renamed("figures", "properties", since="0.2", removed_in="0.4")
@dataclass(frozen=True, kw_only=True)
class RoverAirframe(Airframe):
    """A rover: ``properties.rover``."""

    kind: ClassVar[str] = "rover"
    known = properties(Properties)
    dtype = Properties.dtype
    model = MODEL
