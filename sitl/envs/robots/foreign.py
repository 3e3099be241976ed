# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with a foreign autopilot on our physics. Its program is restarted or rebooted for every episode."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from sitl.autopilot.params import parm_files
from sitl.client.connection import Connection
from sitl.errors import OptionError
from sitl.foreign.betaflight import configuration
from sitl.foreign.choice import ARDUPILOT, BETAFLIGHT, PX4, Choice
from sitl.physics.engine import EngineError
from sitl.plants.local import stand_alone
from sitl.scenario import Scenario
from sitl.vehicles import AirframeError
from sitl.worlds import World

from ..mavlink import px4
from ..mavlink.foreign import Foreign, launch
from ..mavlink.preparation import BY_FORCE, refusal
from ..options import EnvOptionError
from .robot import Pose
from .vehicles import INPROCESS, EpisodeState, Vehicles, VehicleSetup
from .wind import wind_and_own

_NOT_ITS_OWN = ("mocap", "uwb")
"""Sensor sets that an ArduPilot's own receiver is nothing like."""


def of_episodes(choice: Choice, params: Mapping[str, float]) -> dict[str, float]:
    """Parameters of an autopilot in episodes, unless they say something else themselves: a PX4 takes sticks from
    MAVLink."""
    return {**(px4.PARAMETERS if choice.kind == PX4 else {}), **params}


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
        if choice.kind == ARDUPILOT and options.sensors in _NOT_ITS_OWN:
            raise EnvOptionError(
                f"sensors {options.sensors!r}: {self.where} simulates its receiver itself, without the errors of this "
                "one; leave sensors out, or set its own SIM_GPS1_ parameters by params"
            )
        if options.gcs is not None:
            raise EnvOptionError(f"{self.where}: gcs is for our own autopilot in process")
        if choice.program is None and (setup.count > 1 or options.params):
            raise EnvOptionError(f"{self.where} is one vehicle as it is: no count or params")
        super().__init__(setup)

    @property
    def where(self) -> str:
        return f"autopilot {self._choice.name}"

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        wind, own = wind_and_own(self.changed[index].items())
        before, self.links[index] = self.links[index], None
        start = (*pose[:3], math.degrees(pose[3]))
        airframe = self.setup.airframe
        scenario = replace(
            self.setup.scenario, frame=airframe.changed(**own) if own else airframe, world=self.worlds[index],
            seed=seed, start=start,
        )  # fmt: skip
        link = self._booted(before, scenario, wind)
        self.links[index] = link
        return self.begun(index, self.prepare(link, pose))

    def enter(self, index: int, world: World) -> None:
        """See ``Vehicles``: each episode has physics of its own."""
        self.worlds[index] = world

    def _booted(self, before: Connection | None, scenario: Scenario, wind: Mapping[str, float]) -> Foreign:
        """Boot a foreign autopilot on physics at power-on.

        Args:
            before: connection of the last episode; it is closed, or reused when we did not start the program.
            scenario: of this episode, but for its parameters.
            wind: parameters of this episode's wind, over those of the options. An ArduPilot has them, too, because
                what it reports of them acts on the physics.
        """
        choice, options = self._choice, self.options
        rebooted = before if isinstance(before, Foreign) and choice.program is None else None
        if before is not None and rebooted is None:
            before.close()
        try:
            params: Mapping[str, float] = {}
            lines: list[str] = []
            if choice.kind == BETAFLIGHT:
                lines, params = configuration.given(options.params)
            else:
                params = parm_files.given(options.params)
            plant = stand_alone(replace(scenario, params={**choice.for_physics(params), **wind}))
            if rebooted is None:
                own = {**params, **wind} if choice.kind == ARDUPILOT else params
                theirs = lines if choice.kind == BETAFLIGHT else of_episodes(choice, own)
                found = launch(choice, plant, theirs, self.setup.inbox(), options.patience)
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
