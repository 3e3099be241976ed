# SPDX-License-Identifier: BSD-3-Clause
"""What a firmware is on MAVLink: everything in which two firmwares differ there, as data.

``bridge/copter`` and ``bridge/rover`` each define one; services and telemetry read ``bridge.profile``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from ..autopilot.modes import Mode
from ..vehicle.kinds import KINDS
from .autopilot_api import Autopilot
from .core_link import CoreUnits
from .services.command import Entry

if TYPE_CHECKING:
    from .services.setpoints import SetpointService


class Targets(NamedTuple):
    """What a vehicle wants, for HIGH_LATENCY2."""

    altitude: float = 0.0
    """Above mean sea level [m]; 0: it controls none."""
    speed: float = 0.0
    """[m/s]; 0: it controls none."""
    wind_heading: int = 0
    """Of the wind that it knows [2 deg]."""


@dataclass(frozen=True)
class Profile:
    """A firmware's face."""

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
    commands: Mapping[int, Entry]
    """MAV_CMD -> how it is carried out. A number that is not here is answered UNSUPPORTED."""
    set_points: type[SetpointService]
    core: CoreUnits
    """Units that hear and tell clients, with what they can build and take."""
    autopilot: Callable[[Any], Autopilot]
    """The firmware's laws behind the services."""
    silent: frozenset[int] = frozenset()
    """Messages that one may ask for, and that it has nothing to say in (besides those of ``streams.OF_PARTS``)."""
    targets: Callable[[Any], Targets] = lambda v: Targets()
    """Of the vehicle's record."""


def load(kind: str) -> Profile:
    """The profile of a kind of vehicle by its name; its code is loaded with the first vehicle that has it.

    Raises:
        UnknownKindError, MissingPartError: no kind of this name, or it has no face on MAVLink.
    """
    return KINDS[kind].part("mavlink", Profile)
