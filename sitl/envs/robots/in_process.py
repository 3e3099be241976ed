# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with our autopilot in this process.

The state at the start of an episode is calculated once for each start pose and then restored, with a new seed of the
noise.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, ClassVar

from sitl.autopilot.params.parm_files import FileValues, ParameterError
from sitl.bridge.links import LinkAddressError, open_link
from sitl.client.connection import InProcess
from sitl.physics.engine import EngineError
from sitl.physics.engines import NATIVE
from sitl.plants.local import LocalPlant
from sitl.scenario import Scenario
from sitl.simulation import Core, OptionError, Simulation
from sitl.vehicles import AirframeError
from sitl.vehicles.airframe import Value
from sitl.worlds import World

from ..mavlink.preparation import INTERVAL_US
from ..options import EnvOptionError
from .boots import SINGLE, booted, draw
from .moves import BOOT
from .robot import Pose
from .starts import STARTS, Origin, Start
from .vehicles import EpisodeState, Vehicles, VehicleSetup
from .wind import wind_and_own

MAX_ELSEWHERE = 8
"""Vehicles that wait in worlds in which no episode is now."""


def check_parameters(simulation: Simulation) -> None:
    """Warn of parameters of an environment that have no effect."""
    given = isinstance(simulation.scenario.params, FileValues)
    if (idle := simulation.parameters.idle()) and not given:
        warnings.warn(f"no effect in this simulator: {', '.join(idle)}", stacklevel=2)


class InProcessVehicles(Vehicles):
    """See ``Vehicles``. The first one is made at once: options that cannot be taken are refused here."""

    has_snapshots: ClassVar[bool] = True
    min_step: ClassVar[float] = 0.0

    def __init__(self, setup: VehicleSetup) -> None:
        super().__init__(setup)
        self._from: dict[str, Origin] = {}
        """World -> what starts in it depend on."""
        self._elsewhere: dict[tuple[int, str], InProcess] = {}
        """(Number, world) -> the vehicle that was flown in a world that its number has left."""
        self._core: Core | None = None
        gcs = self.options.gcs
        try:
            self._gcs = None if gcs is None else open_link(gcs)
        except LinkAddressError as error:
            raise EnvOptionError(f"gcs: {error}") from None
        self._open()

    def _open(self) -> None:
        """Make the first vehicle: options that cannot be taken are refused here."""
        self._link(0)

    @property
    def where(self) -> str:
        return f"connection {self.options.connection!r}"

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        properties = tuple(sorted(self.changed[index].items()))
        state = self._start_of(pose, properties, self.worlds[index], self._boot_of(seed)).state
        self.restore(index, state)
        self.simulation(index).reseed(seed)
        return state

    def enter(self, index: int, world: World) -> None:
        """See ``Vehicles``: there is a vehicle for each world."""
        if self._gcs is not None:
            raise EnvOptionError(
                f"world {world.name!r}: the vehicle that a ground station (gcs) sees stays in one world"
            )
        left = self.links[index]
        if isinstance(left, InProcess):
            self._elsewhere[index, self.worlds[index].name] = left
        self.worlds[index] = world
        self.links[index] = self._elsewhere.pop((index, world.name), None)
        if len(self._elsewhere) > MAX_ELSEWHERE:
            self._elsewhere.pop(next(iter(self._elsewhere))).close()

    def _boot_of(self, seed: int) -> int:
        """Seed of the boot that an episode begins with."""
        boots = self.options.boots
        return seed if self.options.begin == BOOT and boots > 1 else draw(boots, seed).boot

    def _start_of(
        self, pose: Pose, properties: tuple[tuple[str, Value], ...], world: World, boot: int = SINGLE
    ) -> Start:
        """The vehicle after a boot with this seed and take-off, at a pose in a world; calculated on first use."""
        origin = self._from.get(world.name)
        if origin is None:
            origin = self._from[world.name] = Origin(self.setup, world)
        key = origin, tuple(kind.id for kind in self.setup.wanted), pose, properties, boot
        return STARTS.of(key, lambda: self._started(pose, properties, world, boot))

    def _started(self, pose: Pose, properties: tuple[tuple[str, Value], ...], world: World, boot: int) -> EpisodeState:
        simulation = self._simulation(pose, properties, world, boot)
        link = InProcess(simulation, self.setup.inbox())
        origin = self.prepare(link, pose)
        state = EpisodeState(simulation.snapshot(), link.inbox.memory(), origin, simulation.time_us, "", INTERVAL_US)
        link.close()
        return state

    def _simulation(
        self,
        pose: Pose | None = None,
        properties: Sequence[tuple[str, Value]] = (),
        world: World | None = None,
        boot: int = SINGLE,
    ) -> Simulation:
        simulation: Simulation = self._made(
            pose, properties, lambda scenario: Simulation(scenario, core=self._core), world, boot
        )
        check_parameters(simulation)
        if self.setup.scenario.physics == NATIVE:
            self._core = simulation.core
        return simulation

    def _made(
        self,
        pose: Pose | None,
        properties: Sequence[tuple[str, Value]],
        make: Callable[[Scenario], Any],
        world: World | None = None,
        boot: int = SINGLE,
    ) -> Any:
        """What ``make`` makes of the scenario at a pose, with changed properties, in a world (None: the scenario's).

        Raises:
            EnvOptionError: an option is refused.
        """
        scenario, airframe = booted(self.setup.scenario, self.setup.airframe, boot)
        start = None if pose is None else (*pose[:3], math.degrees(pose[3]))
        wind, own = wind_and_own(properties)
        params = scenario.parameters | wind
        scenario = scenario if world is None else replace(scenario, world=world)
        try:
            scenario = replace(scenario, frame=airframe.changed(**own) if own else airframe, params=params, start=start)
            return make(scenario)
        except (OptionError, AirframeError, EngineError, ParameterError) as error:
            raise EnvOptionError(str(error)) from None

    def _link(self, index: int) -> InProcess:
        link = self.links[index]
        if link is None:
            simulation = self._simulation(world=self.worlds[index])
            link = self.links[index] = InProcess(simulation, self.setup.inbox())
            if index == 0 and self._gcs is not None:
                simulation.bridge.add_link(self._gcs)
        assert isinstance(link, InProcess)
        return link

    def time_us(self, index: int) -> int:
        return self.simulation(index).time_us

    def simulation(self, index: int) -> Simulation:
        return self._link(index).simulation

    def photograph(self, index: int, width: int, height: int) -> Any:
        plant = self.simulation(index).plant
        return plant.engine.render(width, height) if isinstance(plant, LocalPlant) and plant.engine else None

    def snapshot(self, index: int, now: EpisodeState) -> EpisodeState:
        link = self.links[index]
        if not isinstance(link, InProcess):
            raise EnvOptionError(f"{self.where}: only vehicles in process have snapshots")
        return EpisodeState(
            link.simulation.snapshot(), link.inbox.memory(), now.origin, now.began_us, now.setpoint, now.interval_us
        )

    def restore(self, index: int, state: EpisodeState) -> None:
        link = self._link(index)
        try:
            link.simulation.restore(state.simulation)
        except (OptionError, EngineError) as error:
            raise EnvOptionError(f"snapshot cannot be restored: {error}") from None
        link.endpoint.link.receive()
        link.inbox.recall(state.telemetry)
