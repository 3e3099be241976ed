# SPDX-License-Identifier: BSD-3-Clause
"""A ground station in the vehicle's own process: uploads a mission, arms, starts it, all by MAVLink bytes."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

from sitl.autopilot.modes import shown
from sitl.client import Client, ClientError, CommandRefusedError, InProcess, MissionRefusedError, WaitTimeoutError
from sitl.client.waits import READY
from sitl.core.mavlink import MavSeverity
from sitl.errors import SitlError
from sitl.simulation import Simulation

_READY_MESSAGES = ("EKF_STATUS_REPORT", "SYS_STATUS")


class StationError(SitlError, RuntimeError):
    """The vehicle did not do what it was asked to; says what and why, in a line."""


class Station(Client):
    """A client that asks for as little telemetry as it can, and takes mode and arming from the vehicle itself.

    Args:
        simulation: the vehicle.
        advance: lets simulated time pass until a time [us]; it may wait for the wall clock.
        on_step: called after each step of a tenth of a second.
    """

    def __init__(
        self,
        simulation: Simulation,
        advance: Callable[[int], object] | None = None,
        on_step: Callable[[], None] = lambda: None,
    ) -> None:
        self.on_step = on_step
        super().__init__(InProcess(simulation, advance=advance), rates={}, heartbeat=False)

    @property
    def armed(self) -> bool:
        """Whether the vehicle is armed at this moment."""
        return bool(self.simulation.v.autopilot.arming.armed)

    @property
    def mode(self) -> str:
        """The vehicle's mode at this moment."""
        return self.telemetry.mode_names[int(shown(self.simulation.v.autopilot.modes))]

    def step(self, stop_us: int | None = None) -> None:
        super().step(stop_us)
        self.on_step()

    def why(self, since: float = 0.0) -> str:
        """The last two texts since a time [s] that sound like reasons; "" when it said nothing of the kind."""
        severe = [text for time, severity, text in self.texts if severity <= MavSeverity.WARNING and time >= since]
        return ": " + "; ".join(severe[-2:]) if severe else ""

    def wait_ready(self, timeout: float = 120.0) -> None:
        """Until the vehicle has a position and its pre-arm checks are good, at most ``timeout`` [simulated s]."""
        for name in _READY_MESSAGES:
            self.set_rate(name, 5.0)
        super().wait_ready(timeout)
        for name in _READY_MESSAGES:
            self.set_rate(name, 0.0)

    def raise_error(self, error: ClientError) -> NoReturn:
        if isinstance(error, CommandRefusedError):
            why = self.why(error.since - 5.0)
            raise StationError(f"{error.subject} was refused (MAV_RESULT {error.result}){why}")
        if isinstance(error, MissionRefusedError):
            raise StationError(f"{error}{self.why()}")
        if not isinstance(error, WaitTimeoutError):
            raise StationError(ClientError.__str__(error))
        if error.what == READY:
            raise StationError(f"not ready to arm after {self.now:.0f} s{self.why()}")
        raise StationError(f"waited {error.seconds:g} s for {error.what}")
