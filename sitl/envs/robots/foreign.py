# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with a foreign autopilot on our physics. Its program is restarted or rebooted for every episode."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from sitl.autopilot.params import files
from sitl.client.connection import Connection
from sitl.errors import OptionError
from sitl.foreign.choice import Choice
from sitl.physics.engine import EngineError
from sitl.plants.local import stand_alone
from sitl.vehicles import Airframe, AirframeError

from ..mavlink.foreign import Foreign, launch
from ..mavlink.preparation import BY_FORCE, refusal
from ..options import EnvOptionError
from .robot import Pose
from .vehicles import INPROCESS, EpisodeState, Vehicles, VehicleSetup


class ForeignVehicles(Vehicles):
    """See ``Vehicles``.

    Args:
        setup: what they are made from.
        choice: the autopilot.
    """

    def __init__(self, setup: VehicleSetup, choice: Choice) -> None:
        self._choice = choice
        options = setup.options
        if options.connection != INPROCESS:
            raise EnvOptionError(f"{self.where}: it needs no connection besides")
        if options.gcs is not None:
            raise EnvOptionError(f"{self.where}: gcs is for our own autopilot in process")
        if choice.program is None and (setup.count > 1 or options.params):
            raise EnvOptionError(f"{self.where} is one vehicle as it is: no count or params")
        super().__init__(setup)

    @property
    def where(self) -> str:
        return f"autopilot {self._choice.name}"

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        figures, airframe = self.changed[index], self.setup.airframe
        before, self.links[index] = self.links[index], None
        link = self._booted(before, airframe.changed(**figures) if figures else airframe, pose, seed)
        self.links[index] = link
        return self.begun(index, self.prepare(link, pose))

    def _booted(self, before: Connection | None, airframe: Airframe, pose: Pose, seed: int) -> Foreign:
        """Boot a foreign autopilot on physics at power-on.

        Args:
            before: connection of the last episode; it is closed, or reused when we did not start the program.
            airframe: airframe with the figures of this episode.
            pose: start pose x, y, z [m], yaw [rad].
            seed: seed of the physics' noise.
        """
        choice, options = self._choice, self.options
        rebooted = before if isinstance(before, Foreign) and choice.program is None else None
        if before is not None and rebooted is None:
            before.close()
        try:
            start = (*pose[:3], math.degrees(pose[3]))
            params = files.given(options.params)
            scenario = replace(self.setup.scenario, frame=airframe, seed=seed, start=start)
            plant = stand_alone(replace(scenario, params=choice.for_physics(params)))
            if rebooted is None:
                found = launch(choice, plant, params, self.setup.inbox(), options.patience)
                try:
                    self._check(found)
                except BaseException:
                    found.close()
                    raise
                return found
            try:
                self._check(rebooted)
                rebooted.restart(plant)
            except BaseException:
                rebooted.close()
                raise
            return rebooted
        except (OptionError, AirframeError, EngineError) as error:
            raise EnvOptionError(str(error)) from None

    def _check(self, link: Foreign) -> None:
        """Refuse one that was found where it runs and may be no simulator: before it is disarmed or armed."""
        if self._choice.program is None and self.options.reset != BY_FORCE and not link.prove():
            raise refusal(link)

    def physics(self, index: int) -> Any:
        link = self.links[index]
        if not isinstance(link, Foreign):
            return None
        vehicle = link.plant.vehicle
        return vehicle.fleet[vehicle.index : vehicle.index + 1]["physics"]

    def time_us(self, index: int) -> int:
        link = self.links[index]
        assert isinstance(link, Foreign)
        return link.time_us
