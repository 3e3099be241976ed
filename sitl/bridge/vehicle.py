# SPDX-License-Identifier: BSD-3-Clause
"""What the bridge needs of a vehicle. The simulation fulfils it; so does a small fake in the tests."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ..autopilot.firmware import Firmware
from ..physics.carried import Carried


class Vehicle(Protocol):
    """One simulated vehicle."""

    fleet: np.ndarray[Any, Any]
    """Array of records (``sitl.vehicle.record``); its memory stays in place for the vehicle's life."""
    index: int
    v: Any
    """Record view of ``fleet[index]`` with attribute access."""
    firmware: Firmware
    """What flies it: its parameters, modes and name."""

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the simulation [us]; the record's counts from the last boot."""
        ...

    @property
    def has_truth_in_record(self) -> bool:
        """Whether ``truth`` is what the record says (``sitl.physics.carried``): its physics runs in this process."""
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
