# SPDX-License-Identifier: BSD-3-Clause
"""What a firmware is on MAVLink, as telemetry and services see it: data in which firmwares differ."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..autopilot.modes import Mode
from .core_link import CoreUnits


class Targets(NamedTuple):
    """What a vehicle wants, for HIGH_LATENCY2."""

    altitude: float = 0.0
    """Above mean sea level [m]; 0: it controls none."""
    speed: float = 0.0
    """[m/s]; 0: it controls none."""
    wind_heading: int = 0
    """Of the wind that it knows [2 deg]."""


@dataclass(frozen=True, kw_only=True)
class MavlinkFirmware:
    """A firmware, without what carries out commands (``Profile`` has that besides)."""

    firmware: str
    """ArduPilot's name of it."""
    mav_type: int
    """MAV_TYPE of HEARTBEAT"""
    capabilities: int
    """MAV_PROTOCOL_CAPABILITY bits"""
    modes: Sequence[Mode[Any]]
    auto: int
    """Number of the mode that runs missions."""
    guided: int
    """Number of the mode that takes set-points."""
    rtl: int
    groups: Mapping[int, tuple[str, tuple[str, ...]]]
    """MAV_DATA_STREAM -> (ending of the MAV1_ rate parameter, messages)."""
    core: CoreUnits
    """Units that receive from clients and send to them, with what they can build and take."""
    silent: frozenset[int] = frozenset()
    """Messages that one may ask for, and that it has nothing to say in (besides those of ``streams.OF_PARTS``)."""
    targets: Callable[[Any], Targets] = lambda v: Targets()
    """Of the vehicle's record."""
