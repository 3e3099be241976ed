# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with our autopilot on native physics: a fleet, which one compiled call advances.

Each has its own link, and commands and telemetry are MAVLink's bytes, as for one vehicle (``in_process``).
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from sitl.client.connection import InProcess
from sitl.core.kernels import jit_disabled
from sitl.errors import LinkLostError, OptionError
from sitl.fleet import Fleet
from sitl.physics.engine import EngineError
from sitl.simulation import Simulation, Snapshot

from ..mavlink.compiled import (
    ATTITUDE,
    POSITION,
    RC,
    ROVER_ATTITUDE,
    ROVER_POSITION,
    VELOCITY,
    ClientEnd,
    place_all,
    read_all,
    read_one,
    send_all,
)
from ..mavlink.preparation import set_intervals, set_mode
from ..mavlink.setpoints import Encode, override, position, rover_attitude, rover_position, velocity
from ..mavlink.setpoints import attitude as copter_attitude
from ..mavlink.telemetry import PART, StepTelemetry
from ..options import EnvOptionError
from .in_process import MAX_STATES, InProcessVehicles, check_parameters
from .robot import Floats, Pose
from .vehicles import EpisodeState, VehicleSetup

SORTS: dict[Encode, int] = {
    override: RC, velocity: VELOCITY, position: POSITION, copter_attitude: ATTITUDE,
    rover_position: ROVER_POSITION, rover_attitude: ROVER_ATTITUDE,
}  # fmt: skip
"""What makes a set-point's message -> its number in the core."""
Rows = npt.NDArray[np.int64]


class FleetVehicles(InProcessVehicles):
    """See ``Vehicles``; ``step`` advances many at once."""

    takes_threads: ClassVar[bool] = True

    def __init__(self, setup: VehicleSetup) -> None:
        count, readings = setup.count, len(setup.angles)
        parts = -(-readings // PART)
        self._ends: Any = ClientEnd.fleet(count)
        self._hits = self._ends["hits"]
        self._views = [ClientEnd.of(self._ends, k) for k in range(count)]
        for end in self._views:
            end.parts, end.scan_us = parts, -1
        self.scans = np.full((count, parts * PART), np.inf, np.float32)
        """The last whole scans and beyond [m], from right to left."""
        self._coming = self.scans.copy()
        self._origins = np.zeros((count, 3))
        self._ends_for_laws: Any = self._views if jit_disabled() else self._ends
        self._is_open = False
        self._changed: dict[tuple[int, str, int], tuple[Snapshot, Snapshot]] = {}
        """(Identity of a start state, kind of set-point, interval) -> (that state, the same ready for these)."""
        self._begun: list[tuple[Snapshot, int] | None] = [None] * count
        """Start state and seed of each vehicle's episode, until its first step."""
        super().__init__(setup)

    def _open(self) -> None:
        count, threads = self.setup.count, self.options.threads
        self.fleet: Fleet = self._made(
            None, (), lambda scenario: Fleet(scenario, count, threads=threads, core=self._core)
        )
        self._is_open = True
        self._ports = self.fleet.ports.ctypes.data
        shell = self.fleet.shell
        check_parameters(shell)
        self._core = shell.core
        for end in self._views:
            end.system = shell.bridge.system

    # ------------------------------------------------------------------ episodes

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        state = self._restored(pose, tuple(sorted(self.changed[index].items())))
        self._put(index, state, seed)
        self._begun[index] = (state.simulation, seed)
        return state

    def _put(self, index: int, state: EpisodeState, seed: int | None = None) -> None:
        if not self._is_open:
            self._open()
        fleet = self.fleet
        self._begun[index] = None
        try:
            fleet.put(index, state.simulation, seed)
        except (OptionError, EngineError) as error:
            raise EnvOptionError(f"snapshot cannot be restored: {error}") from None
        fleet.receive(index)
        end, telemetry = self._views[index], state.telemetry
        place, angles, (_, scan, scan_us), end.mode, end.armed, _ = telemetry
        end.position_ms, end.position, end.velocity = int(place[0]), place[1:4], place[4:]
        end.attitude_ms, end.euler, end.rates = int(angles[0]), angles[1:4], angles[4:]
        end.scan_us, end.fresh = scan_us, 0
        self.scans[index] = scan
        self._origins[index] = state.origin

    def change(self, index: int, now: EpisodeState, setpoint: str, interval_us: int) -> EpisodeState:
        """Set the mode and the telemetry intervals that a kind of set-point needs, without time going by."""
        begun, self._begun[index] = self._begun[index], None
        if begun is None:
            self.fleet.put(index, self._ready(index, now, setpoint, interval_us))
        else:
            start, seed = begun
            key = (id(start), setpoint, interval_us)
            if key not in self._changed:
                if len(self._changed) >= MAX_STATES:
                    del self._changed[next(iter(self._changed))]
                self._changed[key] = (start, self._ready(index, now, setpoint, interval_us))
            self.fleet.put(index, self._changed[key][1], seed)
        return EpisodeState(None, None, now.origin, now.began_us, setpoint, interval_us)

    def _ready(self, index: int, now: EpisodeState, setpoint: str, interval_us: int) -> Snapshot:
        simulation = Simulation(self.fleet.scenario, core=self._core)
        link = InProcess(simulation, StepTelemetry(len(self.setup.angles)))
        simulation.restore(self.fleet.snapshot(index))
        if now.interval_us != interval_us:
            set_intervals(link, interval_us)
        if now.setpoint != setpoint:
            set_mode(link, self.setup.kind.modes[setpoint])
        return simulation.snapshot()

    # ------------------------------------------------------------------ steps

    def check_open(self) -> None:
        """Before a step.

        Raises:
            LinkLostError: the vehicles have been closed.
        """
        if not self._is_open:
            raise LinkLostError(f"{self.where} is not open; reset() opens it")

    def step(self, rows: Rows, us: int, setpoint: str, commands: Floats, waits_us: Rows | None = None) -> None:
        """Send a set-point to each vehicle, advance it and read its telemetry.

        Args:
            rows: numbers of the vehicles.
            us: how far to advance [us].
            setpoint: kind of set-point.
            commands: one row for each vehicle, shape (count, columns).
            waits_us: how long each set-point is under way [us], shape (count,); None: no time.
        """
        fleet = self.fleet
        late = np.zeros(0, np.int64)
        if waits_us is not None:
            late = rows[waits_us[rows] > 0]
            fleet.advance_us(np.minimum(waits_us[late], us), late)
            self._read(late)
            sends = rows[waits_us[rows] < us]
        else:
            sends = rows
        sort = SORTS[self.setup.kind.encode[setpoint]]
        send_all(sort, sends, commands, self._ends_for_laws, self._origins, self._ports)
        if waits_us is None:
            fleet.advance_us(us, None if len(rows) == len(fleet) else rows)
        else:
            fleet.advance_us(us - np.minimum(waits_us[sends], us), sends)
        self._read(rows)

    def _read(self, rows: Rows) -> None:
        fleet, ports = self.fleet, self._ports
        for index, data in fleet.take_shell_bytes().items():
            held = np.frombuffer(data, np.uint8)
            read_one(index, held.ctypes.data, len(held), self._ends_for_laws, self.scans, self._coming, ports)
        read_all(rows, self._ends_for_laws, self.scans, self._coming, ports)

    def place(self, rows: Rows, base_along: float, state: Floats) -> None:
        """Write where vehicles are (see ``place_robots``)."""
        place_all(rows, self._ends_for_laws, self._origins, base_along, state)

    @property
    def hits(self) -> npt.NDArray[np.int64]:
        """Touches so far, shape (count,)."""
        found: npt.NDArray[np.int64] = self._hits.copy()
        return found

    def times_us(self) -> npt.NDArray[np.int64]:
        """Simulated time of every vehicle [us], shape (count,)."""
        found: npt.NDArray[np.int64] = self.fleet.time_us
        return found

    # ------------------------------------------------------------------ the rest

    def time_us(self, index: int) -> int:
        return int(self.fleet.time_us[index])

    def simulation(self, index: int) -> Simulation:
        """A copy of one vehicle: what is done to it does not reach the fleet."""
        return self.fleet.simulation(index)

    def view(self, index: int) -> Any:
        """See ``Vehicles``; no copy."""
        return self.fleet.view(index)

    def photograph(self, index: int, width: int, height: int) -> Any:
        return None

    def snapshot(self, index: int, now: EpisodeState) -> EpisodeState:
        end = self._views[index]
        telemetry = (
            (end.position_ms, *end.position, *end.velocity),
            (end.attitude_ms, *end.euler, *end.rates),
            (False, self.scans[index].copy(), end.scan_us),
            end.mode,
            end.armed,
            None,
        )
        simulation = self.fleet.snapshot(index)
        return EpisodeState(simulation, telemetry, now.origin, now.began_us, now.setpoint, now.interval_us)

    def restore(self, index: int, state: EpisodeState) -> None:
        self._put(index, state)

    def close(self) -> None:
        self.fleet.close()
        self._is_open = False


def rows_of(rows: npt.NDArray[np.bool_] | None, count: int) -> Rows:
    """Numbers of the robots that are meant."""
    return np.arange(count) if rows is None else np.flatnonzero(rows)
