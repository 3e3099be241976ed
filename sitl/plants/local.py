# SPDX-License-Identifier: BSD-3-Clause
"""Physics in this process: native, which is compiled into one core with the autopilot, or another engine."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Unpack

from ..autopilot import boot
from ..autopilot.params import parm_files
from ..autopilot.params.table import Values
from ..core import rng
from ..core.compile import Progress
from ..core.record_reader import RecordReader
from ..physics.carried import Carried, carried
from ..physics.engine import Engine, EngineError, EngineVehicle, Laws
from ..physics.engines import NATIVE, find
from ..physics.native.ranging import list_near
from ..scenario import Options, Scenario
from ..vehicle.core_entry import Core, bind_unit, load_core
from ..vehicles import Airframe
from .lidar import Company, Rangers, Scene
from .plant import Plant, SimulatedVehicle
from .surroundings import Surroundings


class LocalPlant(Plant):
    """A vehicle's physics and world in this process.

    Args:
        vehicle: record, airframe and kind.
        scenario: what is simulated; its physics is an engine (``sitl.physics.engines.BACKENDS``).
        core: the core of this kind of vehicle, if it is loaded already.
        progress: called for each unit that is compiled.

    Raises:
        OptionError, EngineError, WorldError: what cannot be simulated, named.
        MissingExtra: the engine's library is not installed.
    """

    def __init__(
        self,
        vehicle: SimulatedVehicle,
        scenario: Scenario,
        core: Core | None = None,
        progress: Progress | None = None,
    ) -> None:
        super().__init__(vehicle)
        self.backend = backend = scenario.physics
        self.seed, self.home = scenario.seed_or_default, scenario.home_or_default
        self.world = world = scenario.load_world()
        self.surroundings = Surroundings(world, scenario.start, vehicle.airframe) if world is not None else None
        if self.surroundings is not None:
            self.home = (*self.home[:3], math.degrees(self.surroundings.heading))
        self.rangers: Rangers | None = None
        self.company: Company | None = None
        self.core = core
        self.progress = progress
        self.engine: Engine | None = None
        if backend != NATIVE:
            if vehicle.airframe.properties.get("on_bench"):
                raise EngineError(
                    f"physics {backend!r} has no bench for airframe {vehicle.airframe.name!r}; {NATIVE!r} has"
                )
            self.engine = find(backend, vehicle.kind.name, vehicle.kind.engines)(self._engine_vehicle())
            self.idle_parameters = self.engine.idle_parameters
        self.runs_in_core = self.engine is None
        self._run: Callable[[int], None] | None = None
        self._tick: Callable[[], None] | None = None
        self._event_count = vehicle.reader.field("autopilot.events.count")
        self._attention = vehicle.reader.field("autopilot.events.attention")
        self._clock = vehicle.reader.field("time_us")
        self._wants_list: Callable[[], int] = vehicle.reader.field("physics.obstacles.wanted")

    def _engine_vehicle(self) -> EngineVehicle:
        vehicle = self.vehicle
        units = vehicle.kind.pieces
        laws = Laws(*(self._unit(unit) for unit in (units.begin, units.load, units.sense)))
        floor = self.surroundings.floor if self.surroundings is not None else 0.0
        return EngineVehicle(vehicle.v, vehicle.fleet, vehicle.index, vehicle.airframe, laws, self.world, floor)

    def _unit(self, unit: Callable[..., None]) -> Callable[..., None]:
        vehicle = self.vehicle
        return bind_unit(unit, vehicle.kind, vehicle.fleet, vehicle.index, self.progress)

    # ------------------------------------------------------------------ power-on

    def power_on(self) -> None:
        vehicle, v = self.vehicle, self.vehicle.v
        vehicle.kind.apply_sim_parameters(v)  # first the wind that blows at power-on
        vehicle.kind.init_physics(v, vehicle.airframe, self.home, self.seed)
        vehicle.kind.apply_sim_parameters(v)  # then faults of the new sensors
        around = self.surroundings
        if around is not None:
            around.attach(v, lists_solids=self.engine is None)
        if self.engine is not None:
            self.engine.place()
        if around is not None:
            cast = self.engine.cast if self.engine is not None else None
            self.rangers = Rangers(vehicle, Scene(around.world.geometry, around.floor, cast), self._unit)
            v.physics.downward.in_world = self.rangers.has_rangefinder
            vehicle.kind.apply_sim_parameters(v)
            self.ranging = self.rangers.address
            if self.company is not None:
                self.join(self.company)
            if self.engine is None:
                self._list_near = self._unit(list_near)
                self._list_near(self.ranging)
            self.measure()
            self._note_due()

    def enter(self, around: Surroundings) -> None:
        """Be in other surroundings from now on, and stand there after a power-on; native physics in a world. What the
        record says of solids and readings is not changed."""
        assert self.rangers is not None and self.engine is None
        self.surroundings, self.world = around, around.world
        self.home = (*self.home[:3], math.degrees(around.heading))
        self.rangers.enter(around.world.geometry, around.floor)

    def join(self, company: Company) -> None:
        """Share the world with other vehicles, now and after each power-on; native physics in a world."""
        assert self.rangers is not None
        self.company, p = company, self.vehicle.v.physics
        self.rangers.share(company)
        p.obstacles.present = p.wind.is_shared = True

    # ------------------------------------------------------------------ going on

    def _prepare(self) -> None:
        """List the solids near the vehicle anew, where that is asked for, before a tick that ``Bridge.run`` does not
        make."""
        if self._wants_list():
            self._list_near(self.ranging)
            self.vehicle.v.autopilot.events.attention = 0

    def run(self, ticks: int) -> None:
        if self._run is None:
            self._run = self._runner()
        self._prepare()
        self._run(ticks)

    def _runner(self) -> Callable[[int], None]:
        """What runs ticks of physics and autopilot; compiled now if need be."""
        vehicle, engine = self.vehicle, self.engine
        if engine is None:
            if self.core is None:
                self.core = load_core(vehicle.kind, self.progress)
            return self.core.bind(vehicle.fleet, vehicle.index)
        tick, fly = engine.tick, self._unit(vehicle.kind.fly)
        event_count, attention = self._event_count, self._attention

        def run(ticks: int) -> None:
            before = event_count()
            for _ in range(ticks):
                tick()
                fly()
                if attention() or event_count() != before:
                    return

        return run

    def load(self) -> None:
        """Compile all that ``run`` needs now."""
        if self._run is None:
            self._run = self._runner()

    def load_tick(self) -> None:
        """Compile all that ``tick`` needs now."""
        if self._tick is None:
            self._tick = self.engine.tick if self.engine is not None else self._unit(self.vehicle.kind.step)

    def tick(self) -> None:
        """One tick of physics alone, for an autopilot elsewhere: actuators in, sensors out."""
        if self._tick is None:
            self.load_tick()
        self._prepare()
        self._tick()  # type: ignore[misc]
        self.measure()

    def measure(self) -> None:
        rangers = self.rangers
        if rangers is not None and rangers.due_us <= self._clock():
            rangers.measure()
            self._note_due()

    def _note_due(self) -> None:
        if self.rangers is not None and not self.runs_in_core:
            self.due_us = self.rangers.due_us

    # ------------------------------------------------------------------ the rest

    def truth(self) -> Carried:
        return carried(self.vehicle.v)

    def reseed(self, seed: int) -> None:
        rng.seed(self.vehicle.v.rng, seed)

    def snapshot(self) -> bytes:
        return b"" if self.engine is None else self.engine.snapshot()

    def restore(self, state: bytes) -> None:
        if self.engine is not None:
            self.engine.restore(state)
        if self.rangers is not None:
            self.rangers.find_due()
            self._note_due()

    def close(self) -> None:
        if self.engine is not None:
            self.engine.close()


def stand_alone(
    frame: str | Airframe | Scenario, *, progress: Progress | None = None, **options: Unpack[Options]
) -> LocalPlant:
    """A plant whose vehicle stands at power-on; its record holds an autopilot that nobody runs.

    Args:
        frame: airframe, or a whole scenario; of its parameters the SIM_ ones count.
        progress: called for each unit that is compiled.
        options: the other fields of ``sitl.scenario.Scenario``.

    Raises:
        AirframeError, EngineError, MissingExtra, OptionError, ParameterError, WorldError: what cannot be simulated.
    """
    scenario = Scenario.of(frame, **options)
    airframe, kind = scenario.airframe, scenario.kind
    fleet = kind.record.fleet(1)
    v, table = kind.record.of(fleet, 0), kind.firmware.table
    table.set_defaults(v.autopilot.params)
    values = Values(table, v.autopilot.params)
    parm_files.apply(values, airframe.parameters, airframe.title)
    parm_files.apply(values, scenario.parameters)
    vehicle = SimulatedVehicle(kind, airframe, fleet, 0, v, RecordReader(fleet, 0), lambda: None)
    plant = LocalPlant(vehicle, scenario, None, progress)
    restart(plant)
    return plant


def restart(plant: LocalPlant) -> None:
    """Back to power-on; parameters stay."""
    boot.clear(plant.vehicle.v)
    plant.power_on()
