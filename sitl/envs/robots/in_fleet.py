# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with our autopilot on native physics: a fleet, which one compiled call advances.

Each has its own link, and commands and telemetry are MAVLink's bytes, as for one vehicle (``in_process``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from sitl.bridge.telemetry.builder import by_number
from sitl.bridge.telemetry.plain import build
from sitl.client.connection import InProcess
from sitl.core.geodesy import offset_ne
from sitl.core.kernels import jit_disabled
from sitl.errors import LinkLostError, OptionError
from sitl.fleet import Fleet
from sitl.move import Move
from sitl.physics.engine import EngineError
from sitl.simulation import Simulation, Snapshot
from sitl.turtlebots.native import full_pose
from sitl.vehicle.faults import Failure
from sitl.worlds import World

from ..actions import MOTORS
from ..mavlink.compiled import (
    ACCELERATION,
    ATTITUDE,
    POSITION,
    RATES,
    RC,
    ROVER_ATTITUDE,
    ROVER_POSITION,
    THRUST,
    VELOCITY,
    ClientEnd,
    Origins,
    read_all,
    read_one,
    send_all,
    show_all,
)
from ..mavlink.last_messages import PART
from ..mavlink.preparation import set_bit, set_intervals, set_mode
from ..mavlink.reports import note_report
from ..mavlink.target_messages import (
    Encode,
    acceleration,
    override,
    position,
    rates,
    rover_attitude,
    rover_position,
    thrust,
    velocity,
)
from ..mavlink.target_messages import attitude as copter_attitude
from ..options import EnvOptionError
from .boots import draw
from .in_process import InProcessVehicles, check_parameters
from .moves import BOOT, Prepared
from .robot import Floats, Pose
from .starts import Start
from .true_state import true_reports, truth_writer
from .vehicles import NOT_STARTED, EpisodeState, VehicleSetup

ENCODINGS: dict[Encode, int] = {
    override: RC, velocity: VELOCITY, position: POSITION, copter_attitude: ATTITUDE,
    rover_position: ROVER_POSITION, rover_attitude: ROVER_ATTITUDE, acceleration: ACCELERATION, thrust: THRUST,
    rates: RATES,
}  # fmt: skip
"""What makes a set-point's message -> its number in the core."""
DIRECT = -1
"""In their place: controls of motors."""
Rows = npt.NDArray[np.int64]


class FleetVehicles(InProcessVehicles):
    """See ``Vehicles``; ``step`` advances many at once."""

    takes_threads: ClassVar[bool] = True

    def __init__(self, setup: VehicleSetup) -> None:
        count, readings = setup.count, len(setup.angles)
        parts = -(-readings // PART)
        self._ends: Any = ClientEnd.fleet(count)
        self._views = [ClientEnd.of(self._ends, k) for k in range(count)]
        for end in self._views:
            end.parts, end.scan_us = parts, -1
        self._scans: npt.NDArray[np.float32] = setup.arrays.scan
        self._coming = np.full((count, parts * PART), np.inf, np.float32)
        self._origins = np.zeros((count, 3))
        self._all = np.arange(count)
        self._is_open = False
        self._begun: list[tuple[Start, int, Move | None] | None] = [None] * count
        """Start, seed and move of each vehicle's episode, until its first step."""
        self._prepared: dict[int, Prepared] = {}
        """By the number of the boot."""
        self._failing: dict[int, list[Failure]] = {}
        """What is ordered to fail from the next step on."""
        self._aside: tuple[Fleet | None, World | None, InProcess | None] = None, None, None
        """A vehicle that is made ready for set-points, of which fleet and in which world it is."""
        self._used = "", 0
        """Kind of set-point and interval that a vehicle was last made ready for."""
        lat, lon = setup.options.home[:2]
        self._home = round(1e7 * lat), round(1e7 * lon)
        super().__init__(setup)
        self._floors = _floors(self.worlds)

    def _open(self) -> None:
        count, threads = self.setup.count, self.threads
        self.fleet: Fleet = self._made(
            None, (), lambda scenario: Fleet(scenario, count, threads=threads, core=self._core)
        )
        self._is_open = True
        self.fleet.holds = max(self.fleet.holds, 2 * self.options.boots)  # each, and ready for a kind of set-point
        for index, world in enumerate(self.worlds):
            if world is not self.setup.world:
                self._enter(index, world)
        self._bind()
        shell = self.fleet.shell
        check_parameters(shell)
        self._core = shell.core
        self._builders = by_number(shell.bridge.profile.core.builders)
        for end in self._views:
            end.system = shell.bridge.system

    def enter(self, index: int, world: World) -> None:
        """See ``Vehicles``."""
        if self._is_open:
            self._enter(index, world)
        self.worlds[index] = world
        self._floors = _floors(self.worlds)

    def _enter(self, index: int, world: World) -> None:
        try:
            self.fleet.enter(index, world)
        except OptionError as error:
            raise EnvOptionError(f"world {world.name!r}: {error}") from None

    def _bind(self) -> None:
        """Look up once what every step needs."""
        fleet, arrays, coming = self.fleet, self.setup.arrays, self._coming
        ends: Any = self._views if jit_disabled() else self._ends
        ports = fleet.ports.ctypes.data
        self._send = send_all.bind(ends, self._origins, ports)
        self._read_some = read_all.bind(ends, arrays.scan, coming, ports)
        self._read_bytes = read_one.bind(ends, arrays.scan, coming, ports)
        along = float(self.setup.airframe.value("base_along"))
        origins: Any = Origins(self._origins, *fleet.clocks)
        self._show = show_all.bind(ends, coming, ports, origins, along, arrays)
        self._ranges = fleet.records["sensors"]["lidar_ranges"]
        self._physics = fleet.records["physics"]
        self._write_truth = truth_writer(self._physics["body"])

    # ------------------------------------------------------------------ episodes

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        properties = tuple(sorted(self.changed[index].items()))
        base, world = self.base or self._start, self.worlds[index]
        stays = pose == base and not properties and world is self.setup.world
        if self.options.begin == BOOT or (self.options.boots == 1 and stays):
            start, move = self._start_of(pose, properties, world, self._boot_of(seed)), None
        else:
            boot, walks = draw(self.options.boots, seed)
            start = self._start_of(base, (), self.setup.world, boot)
            prepared = self._prepared.get(boot)
            if prepared is None or prepared.state is not start.state:
                prepared = self._prepared[boot] = Prepared(start.state, self.setup, base)
            move = prepared.to(pose, properties, seed, world, walks)
        state = start.state
        if (ready := start.ready.get(self._used)) is not None:  # as the last episodes went on
            state = EpisodeState(ready, state.telemetry, state.origin, state.began_us, *self._used)
        self._put(index, state, seed, move)
        self._begun[index] = start, seed, move
        return state if move is None else self._moved(index, state, pose)

    @cached_property
    def _start(self) -> Pose:
        """The world's start pose for this vehicle."""
        start = self.setup.world.start(self.setup.airframe.name)
        return full_pose((*start.position, start.yaw), start.position[2])

    def _moved(self, index: int, state: EpisodeState, pose: Pose) -> EpisodeState:
        """After a move: what the vehicle would say now, and where its local frame is."""
        end, e = self._views[index], self.fleet.view(index).autopilot.estimate
        said = np.array([*e.pos, *e.vel, *e.euler, *e.rates], np.float32).tolist()  # as messages carry them
        end.position, end.velocity, end.euler, end.rates = said[:3], said[3:6], said[6:9], said[9:]
        self._scans[index] = self._ranges[index, : self._scans.shape[1]]
        bridge = self.fleet.shell.bridge
        for kind in self.setup.wanted:
            payload = build(self._builders[kind.id], self.fleet.view(index), bridge.shell_port)
            if payload:
                note_report(end.reports, kind, payload)
        north, east = offset_ne(*self._home, e.origin_lat, e.origin_lon)
        self._origins[index] = origin = north, east, -pose[2]
        return EpisodeState(None, None, origin, state.began_us, state.setpoint, state.interval_us)

    def _put(self, index: int, state: EpisodeState, seed: int | None = None, move: Move | None = None) -> None:
        if not self._is_open:
            self._open()
        fleet = self.fleet
        self._begun[index] = None
        try:
            if move is None:
                fleet.put(index, state.simulation, seed)
            else:
                fleet.move(index, move, state.simulation)
        except (OptionError, EngineError) as error:
            if move is not None:
                raise EnvOptionError(f"start: {error}") from None
            raise EnvOptionError(f"snapshot cannot be restored: {error}") from None
        self._failing.pop(index, None)
        fleet.receive(index)
        end, telemetry = self._views[index], state.telemetry
        motion, angles, (_, scan, scan_us), end.mode, end.armed, _, end.reports[:] = telemetry
        end.position_ms, end.position, end.velocity = int(motion[0]), motion[1:4], motion[4:]
        end.attitude_ms, end.euler, end.rates = int(angles[0]), angles[1:4], angles[4:]
        end.scan_us, end.fresh, end.hits = scan_us, 0, 0
        self._scans[index] = scan[: self._scans.shape[1]]
        self._origins[index] = state.origin

    def change(self, index: int, now: EpisodeState, setpoint: str, interval_us: int) -> EpisodeState:
        """Set the mode and the telemetry intervals that a kind of set-point needs, without time going by."""
        begun, self._begun[index] = self._begun[index], None
        self._used = setpoint, interval_us
        if begun is None:
            self.fleet.put(index, self._ready(index, self.fleet.snapshot(index), setpoint, interval_us, now))
        else:
            start, seed, move = begun
            ready = start.ready.get(self._used)
            if ready is None:
                ready = start.ready[self._used] = self._ready(index, start.state.simulation, setpoint, interval_us)
            if move is None:
                self.fleet.put(index, ready, seed)
            else:
                self.fleet.move(index, move, ready)
        return EpisodeState(None, None, now.origin, now.began_us, setpoint, interval_us)

    def _ready(
        self, index: int, start: Snapshot, setpoint: str, interval_us: int, now: EpisodeState = NOT_STARTED
    ) -> Snapshot:
        world = self.worlds[index]
        link = self._aside_in(world if start.world == world.name != self.setup.world.name else None)
        link.simulation.restore(start)
        if now.interval_us != interval_us:
            set_intervals(link, interval_us)
        if now.setpoint != setpoint:
            if setpoint in self.setup.kind.parameters:
                set_bit(link, *self.setup.kind.parameters[setpoint], may_change=True)
            set_mode(link, self.setup.kind.modes[setpoint])
        return link.simulation.snapshot()

    def _aside_in(self, world: World | None) -> InProcess:
        """A vehicle beside the fleet, in a world (None: the fleet's), to be restored; the last one if it is there: to
        make one takes as long as thousands of ticks."""
        fleet, entered, link = self._aside
        if link is None or fleet is not self.fleet or entered is not world:
            scenario = self.fleet.scenario
            if world is not None:
                scenario = replace(scenario, world=world, start=None)
            link = InProcess(Simulation(scenario, core=self._core), self.setup.inbox())
            self._aside = self.fleet, world, link
        link.endpoint.link.receive()
        return link

    # ------------------------------------------------------------------ steps

    def check_open(self) -> None:
        """Before a step.

        Raises:
            LinkLostError: the vehicles have been closed.
        """
        if not self._is_open:
            raise LinkLostError(f"{self.where} is not open; reset() opens it")

    def step(
        self,
        which: npt.NDArray[np.bool_] | None,
        us: int,
        setpoint: str,
        commands: Floats,
        waits_us: Rows | None = None,
    ) -> None:
        """Send a set-point to each vehicle, advance it, read its telemetry and write what is known of it.

        Args:
            which: vehicles that are meant, shape (count,); None: all.
            us: how far to advance [us].
            setpoint: kind of set-point.
            commands: float64, one row for each vehicle in one piece of memory, shape (count, columns).
            waits_us: how long each set-point is under way [us], shape (count,); None: no time.
        """
        fleet, rows, kind = self.fleet, self.rows(which), self.setup.kind
        encoding = DIRECT if setpoint == MOTORS.name else ENCODINGS[kind.encode[setpoint]]
        for index in [k for k in rows.tolist() if k in self._failing] if self._failing else ():
            self._order(index)
        if waits_us is None:
            self._command(rows, encoding, commands)
            fleet.advance_us(us, None if which is None else rows)
        else:
            late, sends = rows[waits_us[rows] > 0], rows[waits_us[rows] < us]
            fleet.advance_us(np.minimum(waits_us[late], us), late)
            self._read_shell_bytes()
            self._read_some(late)
            self._command(sends, encoding, commands)
            fleet.advance_us(us - np.minimum(waits_us[sends], us), sends)
        self.show(rows)

    def _command(self, rows: Rows, encoding: int, commands: Floats) -> None:
        """Send set-points; controls of motors go into the physics."""
        if encoding != DIRECT:
            self._send(rows, encoding, commands)
            return
        assert self.setup.kind.drive is not None
        self.setup.kind.drive(self.fleet.records, rows, commands)

    def fail(self, index: int, failure: Failure) -> None:
        self._failing.setdefault(index, []).append(failure)

    def _order(self, index: int) -> None:
        """Order what is to fail; the vehicle is ready for its set-points."""
        self._begun[index] = None
        for failure in self._failing.pop(index):
            self.fleet.fail(index, failure)

    def rows(self, which: npt.NDArray[np.bool_] | None) -> Rows:
        """Numbers of the vehicles that are meant."""
        return self._all if which is None else np.flatnonzero(which)

    def show(self, rows: Rows) -> None:
        """Read the telemetry of vehicles and write what is known of them into ``setup.arrays``."""
        self._read_shell_bytes()
        self._show(rows)

    def _read_shell_bytes(self) -> None:
        for index, data in self.fleet.take_shell_bytes().items():
            held = np.frombuffer(data, np.uint8)
            self._read_bytes(index, held.ctypes.data, len(held))

    # ------------------------------------------------------------------ the rest

    def time_us(self, index: int) -> int:
        return int(self.fleet.time_us[index])

    def simulation(self, index: int) -> Simulation:
        """A copy of one vehicle: what is done to it does not reach the fleet."""
        return self.fleet.simulation(index)

    def view(self, index: int) -> Any:
        """See ``Vehicles``; no copy."""
        return self.fleet.view(index)

    def true_states(self, ahead: float, out: Floats) -> None:
        self._write_truth(ahead, out)
        if self._floors is not None:
            out[:, 2] += self._floors  # bodies count from the floor

    def true_reports(self, out: Floats) -> None:
        true_reports(self._physics, out)

    def photograph(self, index: int, width: int, height: int) -> Any:
        return None

    def snapshot(self, index: int, now: EpisodeState) -> EpisodeState:
        if index in self._failing:
            self._order(index)
        end = self._views[index]
        telemetry = (
            (end.position_ms, *end.position, *end.velocity),
            (end.attitude_ms, *end.euler, *end.rates),
            (False, self._whole_scan(index), end.scan_us),
            end.mode,
            end.armed,
            None,
            tuple(end.reports.tolist()),
        )
        simulation = self.fleet.snapshot(index)
        return EpisodeState(simulation, telemetry, now.origin, now.began_us, now.setpoint, now.interval_us)

    def _whole_scan(self, index: int) -> npt.NDArray[np.float32]:
        """The last scan, with what fills up its last part."""
        scan = np.full(self._coming.shape[1], np.inf, np.float32)
        scan[: self._scans.shape[1]] = self._scans[index]
        return scan

    def restore(self, index: int, state: EpisodeState) -> None:
        self._put(index, state)

    def use_threads(self, threads: int) -> None:
        super().use_threads(threads)
        self.close()  # the next episode opens a fleet with these threads

    def close(self) -> None:
        self.fleet.close()
        self._is_open = False


def _floors(worlds: Sequence[World]) -> Floats | None:
    """Heights of the floors of vehicles [m]; None: all are 0."""
    heights = np.array([world.floor_z for world in worlds])
    return heights if heights.any() else None
