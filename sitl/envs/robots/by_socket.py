# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle behind a socket, which reboots for every episode."""

from __future__ import annotations

from typing import ClassVar

from gymnasium import logger

from sitl.client.connection import Lockstep, connect
from sitl.errors import OptionError

from ..mavlink.preparation import REBOOT, is_simulator, reboot, refusal
from ..mavlink.telemetry import StepTelemetry
from ..options import EnvOptionError
from .robot import Pose
from .vehicles import EpisodeState, Vehicles, VehicleSetup


class SocketVehicles(Vehicles):
    """See ``Vehicles``; there is one vehicle."""

    simulates: ClassVar[bool] = False

    def __init__(self, setup: VehicleSetup) -> None:
        options = setup.options
        self._connection = options["connection"]
        if options["count"] > 1 or options["gcs"] is not None or options["params"]:
            raise EnvOptionError(
                f"connection {self._connection!r} leads to one vehicle as it is: no count, gcs or params"
            )
        super().__init__(setup)
        self._pose: Pose | None = None

    @property
    def where(self) -> str:
        return f"connection {self._connection!r}"

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        if self._pose not in (None, pose):
            raise EnvOptionError(f"{self.where}: the vehicle starts where it was started")
        self._pose = pose
        link = self.links[0]
        if link is None:
            inbox = StepTelemetry(len(self.setup.angles))
            try:
                link = connect(self._connection, inbox, self.options["patience"], warn=logger.warn)
            except OptionError as error:
                raise EnvOptionError(str(error)) from None
            link.inbox.angles = self.setup.angles
            self.links[0] = link
        else:
            link.is_simulator = is_simulator(link)
        if not link.is_simulator and self.options["reset"] != REBOOT:
            self.close()
            raise refusal(link)
        reboot(link)
        origin = self.prepare(link, pose)
        if isinstance(link, Lockstep):
            link.reseed(seed)
        return self.begun(0, origin)

    def time_us(self, index: int) -> int:
        link = self.links[index]
        assert link is not None
        return link.time_us
