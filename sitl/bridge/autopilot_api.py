# SPDX-License-Identifier: BSD-3-Clause
"""What the bridge needs of a vehicle (the simulation fulfils it; so does a small fake in the tests), and what the
shared MAVLink services ask of its autopilot; each firmware's own services ask more of theirs.

Positions are NED metres from the estimator's origin, angles radians, speeds m/s. Methods say whether the
autopilot did it; what it wants to tell the pilot meanwhile waits in ``take_notes``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from ..autopilot.firmware import Firmware
from ..autopilot.mission.item import MissionItem
from ..autopilot.mission.notes import CurrentChanged, ItemReached, OutputItem, ParametersFound, Text
from ..autopilot.params.table import Values
from ..physics.carried import Carried

LONGEST_US = 3000
"""No pulse on an output is longer [us]. (ArduPilot takes any number, and sends its lowest 16 bits.)"""


class Vehicle(Protocol):
    """One simulated vehicle."""

    fleet: np.ndarray[Any, Any]
    """Array of records (``sitl.vehicle.record``); its memory stays in place for the vehicle's life."""
    index: int
    v: Any
    """Record view of ``fleet[index]`` with attribute access."""
    firmware: Firmware
    """What flies it: its parameters, modes and name."""
    parameters: Values
    """The values of its parameters."""

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the simulation [us]; the record's counts from the last boot."""
        ...

    @property
    def has_truth_in_record(self) -> bool:
        """Whether ``truth`` is what the record says (``sitl.physics.carried``): its physics runs in this process."""
        ...

    @property
    def has_plain_ground(self) -> bool:
        """Whether the ground is a plain without solids, on native physics."""
        ...

    def truth(self) -> Carried:
        """Where the vehicle really is, as HIL_STATE_QUATERNION tells it."""
        ...

    def reseed(self, seed: int) -> None:
        """Another seed for the noise of all sensors from now on."""
        ...

    def request_reboot(self) -> None:
        """Restart the autopilot at the next opportunity (MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN)."""
        ...


Vector = tuple[float, float, float]
Note = Text | ItemReached | CurrentChanged | OutputItem | ParametersFound


class Autopilot(Protocol):
    """What the services call; False: refused.

    Speeds [m/s]; ``lat``, ``lon`` [1e-7 deg]; ``alt`` [m] above sea level; places in NED from the origin [m].
    """

    def armed(self) -> bool: ...
    def mode(self) -> int: ...
    def arm(self, force: bool) -> bool: ...
    def disarm(self, force: bool) -> bool: ...
    def run_prearm_checks(self) -> None: ...
    def set_mode(self, number: int) -> bool: ...
    def run_aux_function(self, number: int, position: int) -> bool: ...
    def set_servo(self, number: int, pulse: int) -> bool: ...  # kept within 0 .. LONGEST_US
    def gripper_is(self, there: bool, is_open: bool) -> None: ...
    def change_speed(self, kind: int, speed: float) -> bool: ...
    def set_home_here(self) -> bool: ...
    def set_home(self, lat: int, lon: int, alt: float) -> bool: ...
    def set_origin(self, lat: int, lon: int, alt: float) -> bool: ...
    def choose_sources(self, number: int) -> None: ...
    def set_battery_left(self, percent: float) -> bool: ...
    def parameter_changed(self, name: str) -> None: ...

    def guided_position(self, place: Vector) -> bool: ...
    def set_roi(self, place: Vector | None) -> None: ...

    def mission_items(self) -> tuple[MissionItem, ...]: ...
    def current_item(self) -> int: ...
    def replace_mission(self, items: tuple[MissionItem, ...]) -> int: ...
    def clear_mission(self) -> bool: ...
    def set_current_item(self, seq: int, reset: bool = False) -> bool: ...
    def start_mission(self) -> bool: ...

    def take_notes(self) -> list[Note]: ...
    def texts_of(self, code: int, a: float, b: float) -> Sequence[Note]: ...
