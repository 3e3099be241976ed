# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle with an autopilot as an environment's robot: commands and telemetry are MAVLink bytes.

An episode starts armed, in GUIDED, a copter in the air. The modules ``in_process``, ``by_socket`` and ``foreign``
differ in how they get vehicles and bring them to that state; a step is the same for all.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl import vehicles, worlds
from sitl.bridge.dialect import message as message_kind
from sitl.client.connection import Connection
from sitl.core.elementary import cos, sin
from sitl.core.mavlink import MavLandedState
from sitl.errors import LinkLostError
from sitl.foreign.betaflight import configuration
from sitl.foreign.choice import ARDUPILOT, BETAFLIGHT, PX4, Choice, choose
from sitl.move import Move, is_changeable
from sitl.physics.engines import NATIVE
from sitl.scenario import Scenario
from sitl.simulation import OptionError, Simulation
from sitl.vehicle.equipment import Equipment
from sitl.vehicle.faults import Failure
from sitl.vehicle.kinds import KINDS
from sitl.vehicles import Airframe, AirframeError
from sitl.vehicles.airframe import Value
from sitl.vehicles.properties.property import Property
from sitl.vehicles.receivers import equipped
from sitl.worlds import World, planar
from sitl.worlds.shapes import from_heading, from_ned, to_ned

from ..actions import MOTORS, Action, Continuous, Setpoint
from ..mavlink.compiled import robot_arrays
from ..mavlink.guard import GUARDED, Watch
from ..mavlink.preparation import ALIGN_US, RESETS, request_again, set_bit, set_intervals, set_mode
from ..mavlink.reports import LANDED, show_report
from ..mavlink.target_messages import Message
from ..options import COMMON, EnvOptionError, unknown, unknown_option
from .at_connection import SocketVehicles
from .boots import check_boots, draw
from .foreign import ForeignVehicles
from .in_fleet import FleetVehicles
from .in_process import InProcessVehicles
from .kind import robot_kind, volume
from .moves import BEGINS, BOOT
from .robot import Floats, Pose
from .true_state import TRUE_REPORT
from .vehicles import INPROCESS, NOT_STARTED, AutopilotOptions, EpisodeState, Vehicles, VehicleSetup

_TRIES = 20


def _words(error: BaseException) -> str:
    """Why a vehicle is handed over; whatever the text of the error does when it is asked for."""
    if isinstance(error, KeyboardInterrupt | SystemExit):
        return "closed"
    name = type(error).__name__
    with suppress(Exception):
        return f"{name}: {str(error)[:200]}"
    return name


def make_vehicles(setup: VehicleSetup, choice: Choice | None) -> Vehicles:
    """Vehicles in process, behind a socket, or with a foreign autopilot, as the options say."""
    if choice is not None:
        return ForeignVehicles(setup, choice)
    if setup.options.connection != INPROCESS:
        return SocketVehicles(setup)
    together = setup.options.physics == NATIVE and setup.options.gcs is None
    return FleetVehicles(setup) if together else InProcessVehicles(setup)


class AutopilotRobot:
    """See ``Robot``. ``"erle_copter"`` and ``"erle_rover"`` are this one with their airframes.

    Args:
        world: world that the vehicles move in.
        count: number of vehicles.
        options: see ``AutopilotOptions``.
    """

    arrays_stay = True
    """See ``sitl.envs.senses.arrays_stay``."""

    def __init__(self, world: str | Path | World = "maze_erlerover", count: int = 1, **options: Any) -> None:
        for option in options:
            if option not in AutopilotOptions.names():
                raise unknown_option(option, [*AutopilotOptions.names(), *COMMON, "render_mode"])
        self._given = {"world": world, "count": count, **options}
        self._options = chosen = AutopilotOptions(**options)
        if chosen.reset not in RESETS:
            raise unknown("reset", chosen.reset, RESETS)
        if chosen.begin not in BEGINS:
            raise unknown("begin", chosen.begin, BEGINS)
        check_boots(chosen.boots)
        try:
            self.airframe = airframe = equipped(vehicles.load(chosen.frame), chosen.sensors)
        except (AirframeError, OptionError) as error:
            raise EnvOptionError(str(error)) from None
        first, self.count = worlds.load(world), count
        self.name = airframe.name
        self.kind = kind = robot_kind(airframe.kind)
        readings = int(airframe.value("lidar_samples"))  # 0: it has no lidar
        if kind.takes_off and not 0.5 <= chosen.take_off <= 100.0:
            raise EnvOptionError(f"take_off = {chosen.take_off}; it must be 0.5 .. 100 m")
        runs = chosen.connection != INPROCESS and chosen.autopilot in (ARDUPILOT, PX4)
        try:
            choice = None if runs else choose(chosen.autopilot, airframe.kind, chosen.autopilot_path)
        except OptionError as error:
            raise EnvOptionError(str(error)) from None
        if (chosen.autopilot if choice is None else choice.kind) == PX4:
            if kind.with_px4 is None:
                raise EnvOptionError(
                    f"autopilot {chosen.autopilot} flies no {airframe.kind} here, and {self.name} is one: leave it "
                    "out, or take an ArduPilot"
                )
            self.kind = kind = kind.with_px4
        if choice is not None and choice.kind == BETAFLIGHT:
            assert kind.with_betaflight is not None  # else it was refused
            self.kind = kind = kind.with_betaflight
        self.range_max = float(airframe.value("lidar_max"))
        self.digit_when_inf = int(self.range_max)
        self.angles = planar.angles(readings, float(airframe.value("lidar_fov")))
        try:
            params = chosen.params
            if choice is not None and choice.kind == BETAFLIGHT:
                params = configuration.given(params)[1]
            scenario = Scenario(airframe, chosen.home, params=params, world=first, physics=chosen.physics)
        except OptionError as error:
            raise EnvOptionError(str(error)) from None
        arrays: Any = robot_arrays(count, readings)
        self.scan, self.state, self.collided, self.time, self._began_us, self.reports = arrays
        self.pose, self.velocity = self.state[:, :4], self.state[:, 4:8]
        self._truth, self._true_reports = np.zeros_like(self.state), np.zeros((count, TRUE_REPORT))
        self._setup = setup = VehicleSetup(chosen, count, airframe, kind, first, scenario, self.angles, arrays)
        self._vehicles = made = make_vehicles(setup, choice)
        is_driven = isinstance(made, FleetVehicles) and kind.drive is not None
        self.step_time, self.setpoints = 0.1, tuple(s for s in kind.setpoints if s is not MOTORS or is_driven)
        self.crash_range, self.tick = kind.crash_range, max(kind.tick, made.min_step)
        self.properties: Mapping[str, Property] = (
            {**{f.name: f for f in airframe.known if is_changeable(f)}, **made.extra_properties}
            if made.simulates
            else {}
        )
        self.volume = volume(airframe, chosen.take_off if kind.takes_off else 0.0)
        each_boots = not made.simulates or choice is not None or (chosen.begin == BOOT and chosen.boots > 1)
        self.boots = 0 if each_boots else int(chosen.boots)
        """Number of prepared boots of which each episode begins with one; 0: there are none."""
        self._seeds = [0] * count
        self._sent: list[Message | None] = [None] * count
        """The last set-point of each episode."""
        self.over = np.zeros(count, np.bool_)
        """Whether an agent is not in charge of its vehicle any more: the episode is truncated."""
        self._commands, self._setpoint = np.zeros((count, 1)), self.setpoints[0]
        self._base_along = float(airframe.value("base_along"))
        self._states = [NOT_STARTED] * count
        self._ready_for: tuple[str, int] = ("", 0)
        """Kind of set-point and interval of telemetry [us] that vehicles of a fleet are ready for."""
        self._unready = set(range(count))
        """Those of them that are not, or whose episode has just begun."""
        self.floors = np.full(count, float(first.floor_z))
        """See ``TravellingRobot``."""

    @property
    def world(self) -> World:
        """See ``Robot``."""
        return self._vehicles.worlds[0]

    @property
    def worlds(self) -> list[World]:
        """See ``TravellingRobot``."""
        return self._vehicles.worlds

    def enter(self, index: int, world: World) -> None:
        """See ``TravellingRobot``."""
        if world is not self.worlds[index]:
            self._vehicles.enter(index, world)
            self.floors[index] = world.floor_z

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """The vehicle kind's actions: see ``kind``."""
        made = self.kind.action(form, setpoint)
        if setpoint is MOTORS and isinstance(made, Continuous):
            count = len(getattr(self.airframe, "rotors"))  # noqa: B009 - a copter has them
            return Continuous(MOTORS, count * [0.0], count * [1.0], range(count))
        return made

    def ask_for(self, message: str) -> None:
        """See ``sitl.envs.senses.ReportingRobot``. Of a vehicle that does not send it, the first reset says so."""
        in_world = self.airframe.value("rangefinder_max") > 0.0 or not self._vehicles.simulates
        if message == "RANGEFINDER" and not in_world:
            raise EnvOptionError(f"airframe {self.name!r} has no range-finder: its rangefinder_max is 0 m")
        kind = message_kind(message)
        if kind not in self._setup.wanted:
            self._setup.wanted.append(kind)

    # ------------------------------------------------------------------ episodes

    def set_property(self, index: int, name: str, value: Value) -> None:
        """See ``Robot``."""
        self._vehicles.changed[index][name] = value

    def prepare_at(self, pose: Pose) -> None:
        """Where a vehicle is prepared that is moved to other start poses; before the first reset.

        Raises:
            EnvOptionError: a position so far away that no vehicle can be moved there.
        """
        north, east, _ = to_ned(*pose[:3])
        try:
            Move(north, east).check(self.airframe)
        except OptionError as error:
            raise EnvOptionError(f"start: {error}") from None
        self._vehicles.base = pose

    @property
    def is_live(self) -> bool:
        """See ``AskedRobot``."""
        return isinstance(self._vehicles, SocketVehicles)

    def use_scan(self, used: bool) -> None:
        """See ``AskedRobot``: a vehicle at a connection is asked for scans only where they are used."""
        self._vehicles.scans_used = used

    def reset(self, index: int, pose: Pose, seed: int) -> None:
        """See ``Robot``."""
        self._unready.add(index)
        self._seeds[index], self._sent[index] = seed, None
        try:
            self._states[index] = self._vehicles.begin(index, pose, seed)
        except LinkLostError:
            self.close()
            raise
        self.collided[index], self.over[index] = 0, False
        self._read(index)

    def boot_of(self, index: int) -> int:
        """Number of the prepared boot that a robot's episode began with, as ``reset`` drew it; -1: there is none."""
        return draw(self.boots, self._seeds[index]).boot if self.boots else -1

    def check_failure(self, failure: Failure) -> None:
        """See ``sitl.envs.faults.FailingRobot``."""
        if not self._vehicles.has_snapshots:
            raise EnvOptionError(f"{self._vehicles.where}: only vehicles in process fail on demand")
        kind, scenario = KINDS[self.airframe.kind], self._setup.scenario
        table, given = kind.firmware.table, {**self.airframe.parameters, **scenario.parameters}
        equipment = Equipment(kind, self.airframe, has_world=True, is_remote=":" in scenario.physics)
        equipment.check(failure.checked(table), lambda name: given.get(name, table[name].default))

    def fail(self, index: int, failure: Failure) -> None:
        """See ``sitl.envs.faults.FailingRobot``."""
        self._vehicles.fail(index, failure)

    # ------------------------------------------------------------------ steps

    def apply(self, setpoint: Setpoint, commands: Floats) -> None:
        """See ``Robot``."""
        self._setpoint, self._commands = setpoint, np.ascontiguousarray(commands, np.float64)

    def advance(self, seconds: float, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """See ``Robot``."""
        us = round(1e6 * seconds)
        if isinstance(self._vehicles, FleetVehicles):
            self._step_all(self._vehicles, rows, us)
            return
        try:
            for index in range(self.count) if rows is None else np.flatnonzero(rows).tolist():
                self._step(index, us)
        except LinkLostError:
            self.close()
            raise

    def advance_late(
        self, seconds: float, waits: npt.NDArray[np.int64], rows: npt.NDArray[np.bool_] | None = None
    ) -> None:
        """See ``Robot``: the set-point message is sent after ``waits`` ticks."""
        us, tick_us = round(1e6 * seconds), round(1e6 * self.tick)
        if isinstance(self._vehicles, FleetVehicles):
            self._step_all(self._vehicles, rows, us, waits * tick_us)
            return
        try:
            for index in range(self.count) if rows is None else np.flatnonzero(rows).tolist():
                self._step(index, us, int(waits[index]) * tick_us)
        except LinkLostError:
            self.close()
            raise

    def _step_all(
        self,
        vehicles: FleetVehicles,
        rows: npt.NDArray[np.bool_] | None,
        us: int,
        waits_us: npt.NDArray[np.int64] | None = None,
    ) -> None:
        """One step of many vehicles at once."""
        vehicles.check_open()
        wanted = setpoint, interval_us = self._setpoint.name, math.gcd(ALIGN_US, us)
        if wanted != self._ready_for:
            self._ready_for, self._unready = wanted, set(range(self.count))
        if self._unready:
            self._make_ready(vehicles, vehicles.rows(rows).tolist(), setpoint, interval_us)
        vehicles.step(rows, us, setpoint, self._commands, waits_us)

    def _make_ready(self, vehicles: FleetVehicles, rows: list[int], setpoint: str, interval_us: int) -> None:
        """Before the first step of episodes, and when another kind of set-point comes."""
        states = self._states
        for index in sorted(self._unready.intersection(rows)):
            now = states[index]
            if now.interval_us != interval_us or not (
                now.setpoint == setpoint or self.kind.are_alike(now.setpoint, setpoint)
            ):
                states[index] = vehicles.change(index, now, setpoint, interval_us)
            self._unready.discard(index)

    def _step(self, index: int, us: int, wait_us: int = 0) -> None:
        link, now, setpoint = self._vehicles.links[index], self._states[index], self._setpoint
        if link is None:
            raise LinkLostError(f"{self._vehicles.where} is not open; reset() opens it")
        inbox, row = link.inbox, self._commands[index].tolist()
        watch = self._vehicles.watch
        if watch is not None and not self._allows(index, watch, row):
            link.run(us)
            self._read(index)
            watch.stepped()
            return
        interval_us = min(math.gcd(ALIGN_US, us), inbox.longest_interval_us)
        if now.interval_us != interval_us or not (
            now.setpoint == setpoint.name or self.kind.are_alike(now.setpoint, setpoint.name)
        ):
            now = self._change(link, now, setpoint.name, interval_us)
            self._states[index] = now
        hits, scans, goal_ms = inbox.hits, inbox.scans, inbox.position[0] + us // 1000
        inbox.reported.clear()
        if wait_us > 0:
            if not link.is_held:
                raise EnvOptionError(f"latency: the clock of {self._vehicles.where} cannot be held within a step")
            self._go_on(index, link, wait_us)
        if wait_us < us:
            if watch is not None:
                row = watch.limited(setpoint, row, self.pose[index].tolist(), 1e-3 * inbox.time_ms)
            if self._puts_down(index, link):
                self._sent[index] = None
            else:
                self._sent[index] = message = self.kind.encode[setpoint.name](row, inbox, now.origin)
                link.endpoint.send_payload(*message)
            self._go_on(index, link, us - wait_us)
        if link.is_exact:
            for _ in range(_TRIES):
                seen = inbox.scans > scans or not inbox.scans_used
                is_whole = seen and len(inbox.reported) == len(inbox.wanted)
                if is_whole and inbox.position[0] == inbox.attitude[0] == goal_ms:
                    break
                request_again(link)
            else:
                raise LinkLostError(f"{link.name}: the vehicle's telemetry is not of this step: has it been rebooted?")
        self.collided[index] = inbox.hits > hits
        self._read(index)
        if watch is not None:
            watch.stepped()

    def _go_on(self, index: int, link: Connection, us: int) -> None:
        """Let time go by within a step; a vehicle that needs its set-point again gets it."""
        repeat_us, message = self.kind.repeat_us, self._sent[index]
        while message is not None and 0 < repeat_us < us:
            link.run(repeat_us)
            link.endpoint.send_payload(*message)
            us -= repeat_us
        link.run(us)

    @property
    def watch(self) -> Watch | None:
        """The guard at work between an agent and a vehicle at a connection; None: there is none."""
        return self._vehicles.watch

    def abandon(self, error: BaseException) -> None:
        """A step or a reset has raised: nobody knows whether another one comes, so a vehicle that may be real is handed
        over."""
        if isinstance(self._vehicles, SocketVehicles):
            self._vehicles.hand_over(_words(error))

    def _allows(self, index: int, watch: Watch, row: list[float]) -> bool:
        """Whether the agent may go on; else the vehicle is somebody else's, or has been handed over."""
        vehicles = self._vehicles
        assert isinstance(vehicles, SocketVehicles)
        if watch.in_charge:
            why = vehicles.taken() or vehicles.asked_to_end() or watch.doubt(self.pose[index].tolist(), row)
            if why:
                vehicles.hand_over(why)
        self.over[index] = not watch.in_charge
        return watch.in_charge

    def _change(self, link: Connection, now: EpisodeState, setpoint: str, interval_us: int) -> EpisodeState:
        """Set the mode and the telemetry intervals that the set-point needs; before the first step of an episode."""
        if now.interval_us != interval_us:
            set_intervals(link, interval_us)
        if now.setpoint != setpoint:
            if setpoint in self.kind.parameters:
                set_bit(link, *self.kind.parameters[setpoint], may_change=self._vehicles.simulates)
            if setpoint in self.kind.before_mode:
                self.kind.before_mode[setpoint](link)
            set_mode(link, self.kind.modes[setpoint])
        return EpisodeState(None, None, now.origin, now.began_us, setpoint, interval_us)

    def _read(self, index: int) -> None:
        """Copy the last telemetry into the arrays."""
        self._began_us[index] = self._states[index].began_us
        if isinstance(self._vehicles, FleetVehicles):
            self._vehicles.show(np.array([index]))
            return
        link, now = self._vehicles.links[index], self._states[index]
        assert link is not None
        inbox = link.inbox
        _, n, e, d, vn, ve, vd = inbox.position
        heading = inbox.attitude[3]
        c, s = cos(heading), sin(heading)
        origin = now.origin
        x, y, z = from_ned(origin[0] + n + self._base_along * c, origin[1] + e + self._base_along * s, origin[2] + d)
        self.state[index] = (
            x, y, z, from_heading(heading), vn * c + ve * s, vn * s - ve * c, -vd, -inbox.attitude[6],
            *inbox.attitude[1:3], *inbox.attitude[4:6],
        )  # fmt: skip
        self.scan[index] = inbox.scan[: self.scan.shape[1]]
        show_report(inbox.reports, heading, self.reports, index)
        self.time[index] = 1e-6 * (self._vehicles.time_us(index) - now.began_us)

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """See ``Robot``; ``reset`` has already read the scan."""

    def why_over(self) -> str:
        """Why the agent is not in charge of its vehicle any more."""
        watch = self._vehicles.watch
        return watch.reason if watch is not None else ""

    def true_state(self) -> Floats:
        """See ``sitl.envs.senses.SensingRobot``; the array is written anew by each call."""
        self._vehicles.true_states(self._base_along, self._truth)
        return self._truth

    def has_landed(self) -> npt.NDArray[np.bool_]:
        """See ``sitl.envs.senses.LandingRobot``."""
        landed: npt.NDArray[np.bool_] = self.reports[:, LANDED] == MavLandedState.ON_GROUND
        return landed

    def let_down(self, height: float) -> bool:
        """See ``sitl.envs.senses.LandingRobot``."""
        if self._vehicles.simulates:
            return False
        self._vehicles.lets_down = height
        return True

    def _puts_down(self, index: int, link: Connection) -> bool:
        """Whether the vehicle gets the set-point of ``let_down`` in place of the agent's."""
        vehicles = self._vehicles
        if vehicles.lets_down <= 0.0 or not isinstance(vehicles, SocketVehicles) or self._setpoint not in GUARDED:
            return False
        if not vehicles.puts_down(float(self.pose[index, 2] - self.world.floor_z)):
            return False
        vehicles.put_down(link)
        return True

    def true_reports(self) -> Floats:
        """See ``sitl.envs.senses.ReportingRobot``; the array is written anew by each call."""
        self._vehicles.true_reports(self._true_reports)
        return self._true_reports

    @property
    def knows_truth(self) -> bool:
        """Whether ``true_state`` and ``true_reports`` are known: the physics is in this process."""
        return self._vehicles.simulates

    @property
    def camera_mount(self) -> tuple[float, float, float, float] | None:
        """Where a camera is by default: forward, left, up of the body's origin [m], as the lidar; and how
        far the robot's base lies ahead of that origin [m]. None: a vehicle in another process, or with a foreign
        autopilot, has none."""
        if not self._vehicles.has_snapshots:
            return None
        forward, right, down = self.airframe.value("lidar_at")
        return forward, -right, -down, self._base_along

    def judged_state(self) -> Floats:
        """See ``sitl.envs.senses.SensingRobot``."""
        return self.true_state() if self._vehicles.simulates else self.state

    def use_threads(self, threads: int) -> None:
        """Let so many threads advance the vehicles, before their first reset; without effect on vehicles that have
        none (see ``AutopilotOptions.threads``). Their number changes no bit of the result."""
        self._vehicles.use_threads(threads)

    def link(self, index: int) -> Connection | None:
        """The connection to a vehicle, after its first reset; None before it, and for vehicles that a fleet flies (in
        process, on native physics, without ``gcs``): they have no connection of their own."""
        return self._vehicles.links[index]

    def simulation(self, index: int) -> Simulation:
        """A simulation in the state of a vehicle in process.

        Of a vehicle that a fleet flies (see ``link``) it is a copy, made at each call, which flies on without the
        environment. To read values, use ``view``.

        Raises:
            EnvOptionError: the vehicle is in another process.
        """
        return self._vehicles.simulation(index)

    def view(self, index: int) -> Any:
        """The record of a vehicle in process (``sitl.vehicle.record``), for values that MAVLink does not send.

        It follows the vehicle, and is to be read only.

        Raises:
            EnvOptionError: the vehicle is in another process.
        """
        return self._vehicles.view(index)

    def photograph(self, index: int, width: int, height: int) -> Any:
        """An image by the physics engine's renderer, shape (height, width, 3), uint8; None when it has no renderer."""
        return self._vehicles.photograph(index, width, height)

    # ------------------------------------------------------------------ snapshots

    @property
    def has_snapshots(self) -> bool:
        """Whether its state can be kept and restored: that of vehicles in process."""
        return self._vehicles.has_snapshots

    def snapshot(self, index: int) -> Any:
        """See ``Robot``."""
        return self._vehicles.snapshot(index, self._states[index])

    def restore(self, index: int, snapshot: Any) -> None:
        """See ``Robot``."""
        if self._vehicles.has_snapshots and not isinstance(snapshot, EpisodeState):
            raise EnvOptionError(f"{snapshot!r} is no snapshot of a vehicle")
        self._unready.add(index)
        self._vehicles.restore(index, snapshot)
        self._states[index] = snapshot
        self.collided[index] = 0
        self._read(index)

    def close(self) -> None:
        """See ``Robot``."""
        self._vehicles.close()

    def __getstate__(self) -> dict[str, Any]:
        if not self._vehicles.has_snapshots:
            raise TypeError(f"an environment on {self._vehicles.where} cannot be pickled")
        kept = [None if state is NOT_STARTED else self.snapshot(i) for i, state in enumerate(self._states)]
        vehicles = self._vehicles
        given = {**self._given, "world": self._setup.world}
        wanted = [kind.name for kind in self._setup.wanted]
        return {"options": given, "worlds": self.worlds, "kept": kept, "changed": vehicles.changed,
                "collided": self.collided, "base": vehicles.base, "wanted": wanted}  # fmt: skip

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(**state["options"])  # type: ignore[misc]
        self._vehicles.changed, self._vehicles.base = state["changed"], state["base"]
        for message in state["wanted"]:
            self.ask_for(message)
        for index, world in enumerate(state["worlds"]):
            if world != self.worlds[index]:
                self.enter(index, world)
        for index, kept in enumerate(state["kept"]):
            if kept is not None:
                self.restore(index, kept)
        self.collided[:] = state["collided"]


def _of_one_kind(usual: str, *, frame: str | Airframe | None = None, **options: Any) -> AutopilotRobot:
    """A robot with an airframe of one kind: what its tasks, actions and observations are made for.

    Raises:
        EnvOptionError: ``frame`` is of another kind than the usual airframe, or cannot be read.
    """
    try:
        airframe = vehicles.load(usual if frame is None else frame)
        vehicles.check_kind(airframe, vehicles.load(usual).kind)
    except AirframeError as error:
        raise EnvOptionError(str(error)) from None
    return AutopilotRobot(frame=usual if frame is None else frame, **options)


ErleRover = partial(_of_one_kind, "erle_rover")
ErleCopter = partial(_of_one_kind, "erle_copter")
