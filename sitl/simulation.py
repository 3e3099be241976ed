# SPDX-License-Identifier: BSD-3-Clause
"""One simulated vehicle with autopilot, mission and MAVLink bridge, and the clock that only this module advances."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, Protocol, Unpack

import numpy as np

from .autopilot import boot, shell_parameters
from .autopilot.aux_functions import AuxFunctions
from .autopilot.mission.mission import Mission
from .autopilot.mission.sequencer import Sequencer
from .autopilot.params import parm_files
from .autopilot.params.table import Values
from .bridge.bridge import EPOCH_US, Bridge, BridgeState
from .bridge.links import Link, LinkFaults
from .bridge.services.failure_injection import FaultService
from .bridge.services.statustext import EventService, StatusTextService
from .bridge.services.terrain_protocol import TerrainService
from .bridge.wire.fleet import GOES_ON, TO_SERVE
from .core.compile import Progress
from .core.constants import TICK_US
from .core.mavlink import MavSeverity
from .core.record_reader import RecordReader
from .errors import OptionError
from .physics.carried import Carried
from .physics.engines import NATIVE
from .plants.local import LocalPlant
from .plants.plant import PhysicsLostError, Plant, SimulatedVehicle, is_remote, remote
from .plants.surroundings import Surroundings
from .scenario import Options, Scenario
from .vehicle import sim_parameters
from .vehicle.core_entry import Core, load_core
from .vehicle.faults import Failure
from .vehicle.kind import load
from .vehicles import Airframe, AirframeError
from .worlds import World, heights

Array = np.ndarray[Any, Any]
ROUNDS = 8
"""So often at once a mission goes on with what came of its own do-commands."""


class Observer(Protocol):
    """Looks at a vehicle at simulated times of its own choosing; it changes nothing."""

    due_us: int
    """When it wants to look next: simulated time since the start of the simulation [us]."""

    def observe(self) -> None:
        """Look: it is ``due_us`` or the tick after; all that falls due at this time has been sent. Sets ``due_us``."""


class Logger(Protocol):
    """Takes rows of a vehicle's record at regular times; the core takes them for it while it runs."""

    def before_run(self, in_core: bool) -> tuple[int, int]:
        """How the next run samples.

        Args:
            in_core: physics and autopilot run in the core.

        Returns:
            Address of the ``Sampler`` that the core uses (``sitl.vehicle.sampler``), 0: none; and when the logger
            itself wants to look next, simulated time since the start of the simulation [us].
        """
        ...

    def after_run(self) -> None:
        """Look at what the core took, and at the vehicle when it is time: all that falls due now has been sent."""


@dataclass(frozen=True)
class Snapshot:
    """Everything that a later :meth:`Simulation.restore` needs to continue bit for bit."""

    airframe: str
    """Name of the airframe that it is of."""
    record: bytes
    mission: Mission
    bridge: BridgeState
    before_boot_us: int
    events_seen: int
    reboot: bool
    world: str | None = None
    """Name of the world that it is in."""
    physics: str = NATIVE
    """What it is simulated by."""
    plant: bytes = b""
    """What that holds besides the record."""
    parameters: tuple[tuple[str, float], ...] = ()
    """Parameters without effect, as far as they were set: they are not in the record."""


class Simulation:
    """A vehicle from power-on, advanced in simulated time.

    Args:
        frame: airframe name, path of a file that defines one, an Airframe, or a whole ``Scenario``.
        core: the core of this kind of vehicle, if it is loaded already.
        progress: called for each unit that is compiled.
        options: the other fields of ``sitl.scenario.Scenario``: home, seed, estimator, params, world, start, physics.

    Raises:
        OptionError, sitl.physics.engine.EngineError, sitl.vehicles.AirframeError, ParameterError,
            sitl.worlds.WorldError: an argument that cannot be taken, named.
        MissingExtra: the library of an engine is not installed.
        PhysicsLostError: no physics at that address.
    """

    def __init__(
        self,
        frame: str | Airframe | Scenario | None = None,
        *,
        core: Core | None = None,
        progress: Progress | None = None,
        **options: Unpack[Options],
    ) -> None:
        self.scenario = scenario = Scenario.of(frame, **options)
        """What is simulated, as it was told."""
        self.airframe = scenario.airframe
        self.seed, self.estimator, self.physics = scenario.seed_or_default, scenario.estimator, scenario.physics
        self.kind = scenario.kind
        self.firmware = self.kind.firmware
        self.fleet: Array = self.kind.record.fleet(1)
        self.index = 0
        self.v = self.kind.record.of(self.fleet, self.index)
        size = self.fleet.dtype.itemsize
        self._record = memoryview(self.fleet.view("u1"))[self.index * size : (self.index + 1) * size]  # type: ignore[arg-type]
        reader = RecordReader(self.fleet, self.index)
        self._clock: Callable[[], int] = reader.field("time_us")
        self._event_count = reader.field("autopilot.events.count")
        self._events_seen = 0
        self.before_boot_us = 0
        """Simulated time that passed before the last reboot [us]."""
        self._reboot = False
        self.observers: list[Observer] = []
        self.logger: Logger | None = None
        self.firmware.table.set_defaults(self.v.autopilot.params)
        self.parameters = Values(self.firmware.table, self.v.autopilot.params)
        label = self.airframe.title
        unknown = parm_files.apply(self.parameters, self.airframe.parameters, label)
        if unknown:
            raise AirframeError(f"{label}: {parm_files.unknown(self.kind.name, unknown, self.firmware.table)}")
        if unknown := parm_files.apply(self.parameters, scenario.parameters):
            raise parm_files.ParameterError(parm_files.unknown(self.kind.name, unknown, self.firmware.table))
        if core is not None and core.kind is not self.kind:
            raise OptionError(f"the core is of a {core.kind.name}, airframe {self.airframe.name} is a {self.kind.name}")
        vehicle = SimulatedVehicle(
            self.kind, self.airframe, self.fleet, self.index, self.v, reader, self._physics_restarted
        )
        if is_remote(self.physics):
            self.plant: Plant = remote(vehicle, scenario)
            self.world: World | None = None
            """Where it is; None: on a plain without end, or known at the other end of the link alone."""
            self.home = scenario.home_or_default
        else:
            plant = LocalPlant(vehicle, scenario, core, progress)
            self.plant, self.world, self.home = plant, plant.world, plant.home
        self.mission = Mission()
        self._power_on()
        self.bridge = Bridge(self)
        self.bridge.core.load(self.plant.runs_in_core, progress)
        if isinstance(self.plant, LocalPlant):
            self.plant.load()
        try:
            if scenario.terrain is not None:
                self.bridge.get(TerrainService).use(heights.load(scenario.terrain, self.home[:3]))
            for fault in scenario.faults:
                self.bridge.get(FaultService).fail(Failure.of(fault))
        except OptionError:
            self.close()
            raise

    @property
    def resolved(self) -> Scenario:
        """What is simulated, with what was left open filled in."""
        return replace(self.scenario, home=self.home, seed=self.seed)

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the simulation [us]; reboots do not set it back."""
        return self.before_boot_us + self._clock()

    @property
    def elapsed_us(self) -> int:
        """The same, under the name that logs use."""
        return self.time_us

    @property
    def core(self) -> Core:
        """The compiled core of native physics and this firmware: to be shared with other simulations."""
        given = self.plant.core if isinstance(self.plant, LocalPlant) else None
        return given or load_core(self.kind)

    def advance(self, seconds: float) -> None:
        """Advance by a simulated time, rounded up to whole ticks of 2.5 ms.

        Raises:
            OptionError: ``seconds`` is negative or not a finite number.
        """
        if not (isinstance(seconds, Real) and 0.0 <= seconds < math.inf):
            raise OptionError(f"cannot advance by {seconds!r} s: a number from 0 on is needed")
        self.advance_to(self.time_us + round(seconds * 1e6))

    def advance_to(self, time_us: int) -> None:
        """Advance until simulated time ``time_us``, serving MAVLink on the way, exactly when each message falls due.

        What clients sent is read at the beginning; the clock ends on the first whole tick at or after ``time_us``.

        Raises:
            PhysicsLostError: the physics at the other end of a link has gone; time stands where it is, and the same
                call goes on from there once the physics is back.
        """
        if self._goes_there(time_us):
            return
        bridge, plant = self.bridge, self.plant
        if bridge.board.journal is not None:
            bridge.board.journal.attended()
        while True:
            if self._event_count() != self._events_seen:
                self._follow_events()
            if self._reboot:
                self._do_reboot()
                bridge = self.bridge
            now = self._clock()
            stop = time_us - self.before_boot_us
            if now >= stop:
                if bridge.board.journal is not None:
                    bridge.board.journal.arrived()
                return
            by_itself = plant.runs_in_core and bridge.goes_by_itself()
            shell_us = bridge.shell_due_us() if by_itself else bridge.next_due_us()
            if plant.due_us < shell_us:
                shell_us = plant.due_us
            until = shell_us if shell_us < stop else stop
            sampler = 0
            if self.logger is not None:
                sampler, due_us = self.logger.before_run(plant.runs_in_core)
                until = min(until, due_us - self.before_boot_us)
            faults = bridge.board.faults
            if faults.are_on:
                until = min(until, max(faults.due_us(bridge.channels) - self.before_boot_us, now + 1))
            for observer in self.observers:
                until = min(until, observer.due_us - self.before_boot_us)
            lost = None
            try:
                if plant.runs_in_core:
                    bridge.run(plant.ranging, sampler, until, shell_us)
                else:
                    plant.run(max((until - now + TICK_US - 1) // TICK_US, 1))
            except PhysicsLostError as error:
                lost = error
            now = self._clock()
            if shell_us <= now or self._event_count() != self._events_seen or bridge.is_behind(now):
                self.serve()
            else:  # the core has sent all that is due
                bridge.flush()
            if faults.are_on and faults.due_us(bridge.channels) <= self.time_us:
                if self._event_count() != self._events_seen:
                    self._follow_events()  # as if the caller had stopped here and the client spoken now
                bridge.arrive()
            if self.logger is not None:
                self.logger.after_run()
            for observer in self.observers:
                if observer.due_us <= self.time_us:
                    observer.observe()
            if lost is not None:
                raise lost

    def _goes_there(self, time_us: int) -> bool:
        """Read what clients sent; whether the core has then gone on to ``time_us`` by itself, as mostly it does."""
        bridge, seen = self.bridge, self._events_seen
        is_simple = self.plant.runs_in_core and not (
            self.observers or self.logger or self._reboot or bridge.board.is_outside
        )
        if not is_simple or self._event_count() != seen or not bridge.goes_by_itself():
            bridge.receive()
            return False
        needs_shell = bridge.go_on(self.plant.ranging, time_us - self.before_boot_us, seen)
        if needs_shell == GOES_ON:
            return True
        self.attend(needs_shell)
        return False

    def attend(self, needs_shell: int) -> None:
        """Do what the core has left to the shell (``bridge.wire.fleet``), and read on what clients sent."""
        if needs_shell == TO_SERVE:
            self.serve()
        elif self._event_count() != self._events_seen:  # the law of a message had something to say
            self.bridge.get(EventService).read()
        self.bridge.receive(resume=True)

    def serve(self) -> None:
        """After a run of the core: measure, follow up what happened, send what is due and the core did not send."""
        if self.plant.due_us <= self._clock():
            self.plant.measure()
        if self._event_count() != self._events_seen:
            self._follow_events()
        self.bridge.service()

    def set_link_faults(self, faults: LinkFaults | None, link: Link | None = None) -> None:
        """Let the links of clients lose, delay or change frames from now on, see docs/faults.md.

        Args:
            faults: what happens to frames; None: nothing any more, but what is under way arrives when it would have.
            link: one that was added to ``bridge``; None: all, later ones too.
        """
        self.bridge.set_link_faults(faults, link)

    def fail(self, failure: Failure | str) -> None:
        """Let something fail, see docs/faults.md.

        Args:
            failure: what, and when from now on; a text as of ``Failure.of_text``: "gps@12", "motor:2=0.5@20..30".

        Raises:
            OptionError: this vehicle has no such fault; the message says what it has.
        """
        failure = Failure.of(failure)
        self.bridge.get(FaultService).fail(failure)
        self._note_fault(str(failure))

    def repair(self, unit: str = "", instance: int = 0) -> None:
        """Faults are over, those to come too: parameters are what they would be without them.

        Args:
            unit: as "gps" or "gps/wrong", or a ``SIM_`` parameter; "": all that has failed; or a fault with its amount
                or time, "motor:2=0.5@20.0..30.0": that one.
            instance: which one, from 1; 0: all.

        Raises:
            OptionError: there is no such unit, type or instance.
        """
        faults = self.bridge.get(FaultService)
        repair = faults.repair_of(unit, instance)
        faults.repair(repair)
        self._note_fault(f"-{repair}")

    def order_fault(self, text: str) -> None:
        """``fail`` or ``repair`` by the text under which recordings keep it."""
        if text.startswith("-"):
            self.repair(text[1:].removesuffix(":0"))
        else:
            self.fail(text)

    def _note_fault(self, text: str) -> None:
        if self.bridge.board.journal is not None:
            self.bridge.board.journal.failed(text)

    def view(self, height: int = 480, port: int = 0) -> Any:
        """Show the vehicle on a page of the browser, in a notebook as the cell's output, while it is advanced.

        Args:
            height: of the cell's output [pixels].
            port: of the page on this machine; 0: a free one.

        Returns:
            ``sitl.view.inline.InlineView``; its ``close`` ends it, ``page.address`` is where a browser finds it.

        Raises:
            MissingExtra: the extra ``view`` is not installed.
        """
        return load("sitl.view.inline:InlineView")(self, height, port)

    def snapshot(self) -> Snapshot:
        """A copy of everything in the vehicle; later restores leave it as it is."""
        return self.state(self._record.tobytes())

    def state(self, record: bytes = b"") -> Snapshot:
        """The same with another record, or without one: what the shell holds of the vehicle."""
        return Snapshot(
            self.airframe.name,
            record,
            self.mission,
            self.bridge.snapshot(),
            self.before_boot_us,
            self._events_seen,
            self._reboot,
            self.world.name if self.world is not None else None,
            self.physics,
            self.plant.snapshot(),
            tuple(self.parameters.kept.items()),
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Put the vehicle, its autopilot, mission and telemetry back to a snapshot of this airframe.

        The same commands then give the same bytes again. Bytes that a client has sent but the vehicle not read
        yet, and the other way round, stay where they are.
        """
        if snapshot.airframe != self.airframe.name:
            raise OptionError(f"the snapshot is of airframe {snapshot.airframe}, this is {self.airframe.name}")
        here = self.world.name if self.world is not None else None
        if snapshot.world != here:
            raise OptionError(f"the snapshot is of world {snapshot.world}, this is world {here}")
        if snapshot.physics != self.physics:
            raise OptionError(f"the snapshot is of physics {snapshot.physics}, this is {self.physics}")
        self.bridge.get(FaultService).look()  # at the time that is left
        kept = self._record.tobytes()
        if self.bridge.board.journal is not None:
            self.bridge.board.journal.restored()
        self._record[:] = snapshot.record
        try:
            self.plant.restore(snapshot.plant)
        except Exception:
            self._record[:] = kept  # all of it or nothing
            raise
        self._resume(snapshot)

    def enter(self, around: Surroundings) -> None:
        """Be in another world from now on; a vehicle on native physics in a world. Its record is not changed:
        ``restore`` or ``take_up`` follows."""
        assert isinstance(self.plant, LocalPlant)
        self.plant.enter(around)
        self.world, self.home = around.world, self.plant.home

    def take_up(self, state: Snapshot, record: memoryview) -> None:
        """``restore`` of a ``state`` and a record, both of a simulation of this scenario on native physics: they are
        not looked at."""
        self._record[:] = record
        self.plant.restore(state.plant)
        self._resume(state)

    def _resume(self, state: Snapshot) -> None:
        self.mission, self.before_boot_us = state.mission, state.before_boot_us
        self._events_seen, self._reboot = state.events_seen, state.reboot
        self.parameters.kept = dict(state.parameters)
        self.bridge.restore(state.bridge)

    def _physics_restarted(self) -> None:
        """A physics elsewhere has begun anew: the autopilot begins anew with it."""
        self.bridge.get(StatusTextService).say(MavSeverity.WARNING, "Physics began anew: rebooting")
        self._reboot = True

    def request_reboot(self) -> None:
        """Restart vehicle and autopilot before the next tick; parameters and mission stay, links stay open."""
        self._reboot = True

    def parameter_changed(self, name: str) -> None:
        """A parameter was set over MAVLink: the simulated world follows the ``SIM_`` ones."""
        if self.firmware.table[name].has_effect and sim_parameters.acts_on_the_world(name):
            self.plant.parameter_changed(name)

    def reseed(self, seed: int) -> None:
        """Another seed for the noise of all sensors from now on."""
        self.plant.reseed(seed)

    @property
    def has_truth_in_record(self) -> bool:
        """Whether ``truth`` is what the record says: the physics runs in this process."""
        return self.plant.has_truth_in_record

    @property
    def has_plain_ground(self) -> bool:
        """Whether the ground is a plain without solids, on native physics."""
        return self.world is None and self.physics == NATIVE

    def truth(self) -> Carried:
        """Where the vehicle really is, as HIL_STATE_QUATERNION reports it."""
        return self.plant.truth()

    def close(self) -> None:
        """Close links, log and physics."""
        self.bridge.close()
        self.plant.close()

    def _power_on(self) -> None:
        self.firmware.give_back(self.v)
        boot.clear(self.v)
        self.plant.power_on()
        if shell_parameters.clears_mission(self.parameters):
            self.mission = Mission()
        boot_us = lambda: EPOCH_US + self.before_boot_us  # noqa: E731
        self.sequencer = Sequencer(self, self.firmware.commands, boot_us)  # tells the mission: INITIAL_MODE may be AUTO
        self.aux = AuxFunctions(self, self.firmware.aux_functions)
        self.firmware.power_on(self.v)
        self.kind.apply_sim_parameters(self.v)
        self.v.autopilot.ekf.use_external = self.estimator == "truth"

    def _follow_events(self) -> None:
        """Report to clients what happened in the core, and let the mission go on where it waits for that."""
        self.bridge.report(self.aux.attend())  # first: what switches do makes events of its own
        self.v.autopilot.events.attention = False
        self.bridge.on_events()
        for _ in range(ROUNDS):
            notes = self.sequencer.attend()
            if not notes:
                break
            self.bridge.report(notes)  # what a do-command asks for may make events, too
        self._events_seen = int(self._event_count())

    def _do_reboot(self) -> None:
        self.before_boot_us = self.time_us
        self._events_seen = 0
        self._power_on()  # raises when the physics is not there: the next call begins here again
        self._reboot = False
        self.bridge = self.bridge.successor()
