# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle with an autopilot as an environment's robot: everything passes as MAVLink bytes, in process or by socket.

An episode begins armed, in GUIDED, a copter in the air. In process that state is reached once for each start pose and
then restored, with a new seed for the noise; by socket the vehicle reboots for every episode.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl import vehicles, worlds
from sitl.autopilot.params.files import ParameterError
from sitl.bridge.links.address import LinkAddressError, open_link
from sitl.core.geodesy import offset_ne
from sitl.foreign.choice import PX4, Choice, choose
from sitl.physics.engine import EngineError
from sitl.physics.engines import BACKENDS, NATIVE
from sitl.plants.local import LocalPlant
from sitl.simulation import DEFAULT_HOME, Core, Home, OptionError, Simulation
from sitl.vehicles import Airframe, AirframeError
from sitl.vehicles.figures.figure import Figure
from sitl.worlds import World, planar
from sitl.worlds.frames import from_heading, from_ned

from ..actions import Action
from ..mavlink import px4, setpoints
from ..mavlink.connection import Connection, InProcess, Lockstep, connect
from ..mavlink.ends import LinkLostError
from ..mavlink.foreign import Foreign
from ..mavlink.preparation import ALIGN_US, INTERVAL_US, hear_again, prepare, reboot, set_intervals, set_mode
from ..options import EnvOptionError, unknown
from ..setpoints import Setpoint
from . import foreign
from .autopilot_kinds import KINDS, PX4_KIND
from .robot import Floats, Pose, Volume

INPROCESS = "inprocess"
_MOST_READY = 64
"""Start poses of which the state after take-off is kept."""
_TRIES = 20
_AT_REST = (1500.0, 1500.0, 1500.0, 1500.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Ready:
    """A vehicle at a moment, and what its client has heard until then; can be pickled."""

    simulation: Any
    heard: Any
    origin: tuple[float, float, float]
    """NED in the world of the origin of the vehicle's local positions [m]."""
    began_us: int
    """Simulated time at which the episode began [us]."""
    setpoint: str
    """Kind that the vehicle's mode is for; "" before the first."""
    interval_us: int
    """Of telemetry."""


class AutopilotRobot:
    """See ``Robot``. ``"erle_copter"`` and ``"erle_rover"`` are this one with their airframes.

    Args:
        world: that it moves in.
        count: of vehicles.
        frame: airframe: a name, a .py file, or an ``Airframe``; it needs a lidar.
        connection: "inprocess", or where a vehicle is reached: "udp:HOST:PORT", "udpout:HOST:PORT", "tcp:HOST:PORT".
            One started with ``sitl run --lockstep`` goes exactly as far as each step says; others run in real time.
        take_off: height that a copter hovers at when an episode begins [m].
        home: latitude, longitude [deg], altitude [m] of the world's origin (its heading does not count).
        params: values under ArduPilot's names, in process.
        gcs: where a ground station listens to the first vehicle, as ``sitl run --out`` has it; None: nowhere.
        patience: wall time without an answer after which a connection is lost [s].
        physics: what simulates it, in process or under a foreign autopilot: "native", "pybullet" (see
            ``sitl.simulation.Simulation``).
        autopilot: "native", or a foreign one on our physics, by its program or by where its MAVLink is:
            "ardupilot:PROGRAM", "ardupilot:tcp:HOST:PORT" (``sitl.foreign.choice``). It is started, or rebooted, for
            each episode, and has no snapshots.
        autopilot_path: the program, when ``autopilot`` does not say.
    """

    def __init__(
        self,
        world: str | Path | World = "maze_erlerover",
        count: int = 1,
        frame: str | Airframe = "erle_rover",
        connection: str = INPROCESS,
        take_off: float = 1.0,
        home: Home = DEFAULT_HOME,
        params: Mapping[str, float] | None = None,
        gcs: str | None = None,
        patience: float = 10.0,
        physics: str = NATIVE,
        autopilot: str = NATIVE,
        autopilot_path: str | Path | None = None,
    ) -> None:
        self._options: dict[str, Any] = {
            "world": world, "count": count, "frame": frame, "connection": connection, "take_off": take_off,
            "home": home, "params": params, "gcs": gcs, "patience": patience, "physics": physics,
            "autopilot": autopilot, "autopilot_path": autopilot_path,
        }  # fmt: skip
        try:
            self.airframe = airframe = vehicles.load(frame)
        except AirframeError as error:
            raise EnvOptionError(str(error)) from None
        self.world, self.count = worlds.load(world), count
        self.name = airframe.name
        self.kind = kind = KINDS[airframe.kind]
        readings = int(airframe.value("lidar_samples"))
        if readings < 1:
            raise EnvOptionError(f"airframe {self.name!r} has no lidar: its lidar_samples is 0")
        if airframe.kind == "copter" and not 0.5 <= take_off <= 100.0:
            raise EnvOptionError(f"take_off = {take_off}; it must be 0.5 .. 100 m")
        try:
            self._choice = choose(autopilot, airframe.kind, autopilot_path)
        except OptionError as error:
            raise EnvOptionError(str(error)) from None
        if self._choice is not None and self._choice.kind == PX4:
            self.kind = kind = PX4_KIND
        self._in_process = connection == INPROCESS and self._choice is None
        if self._choice is not None:
            foreign.check(self._choice, self._options, count)
        if connection != INPROCESS and (count > 1 or gcs is not None or params):
            raise EnvOptionError(f"connection {connection!r} leads to one vehicle as it is: no count, gcs or params")
        if physics not in BACKENDS or (physics != NATIVE and connection != INPROCESS):
            raise EnvOptionError(f"physics {physics!r}: it is one of {', '.join(BACKENDS)}, of a vehicle in process")
        self.step_time, self.setpoints = 0.1, tuple(kind.setpoints)
        self.crash_range, self.tick = kind.crash_range, kind.tick if self._in_process else max(kind.tick, 0.005)
        self.figures: Mapping[str, Figure] = (
            {f.name: f for f in airframe.known if f.length == 1 and not f.whole} if connection == INPROCESS else {}
        )
        reach = max(abs(x) for x in airframe.value("contact_along")) if airframe.value("contact_discs") > 1 else 0.0
        above = take_off if airframe.kind == "copter" else 0.0
        self.volume = Volume(  # with the room to climb
            float(reach + airframe.value("contact_radius")),
            0.0 - float(airframe.value("contact_bottom")),
            float(airframe.value("contact_top")) + above,
        )
        self.range_max = float(airframe.value("lidar_max"))
        self.digit_when_inf = int(self.range_max)
        self.angles = planar.angles(readings, float(airframe.value("lidar_fov")))
        self.scan = np.full((count, readings), np.inf, np.float32)
        self.collided = np.zeros(count, np.int64)
        self._state = np.zeros((count, 8))
        self.pose, self.velocity = self._state[:, :4], self._state[:, 4:]
        self.time = np.zeros(count)
        self._commands, self._setpoint = np.zeros((count, 1)), self.setpoints[0]
        self._base_along = float(airframe.value("base_along"))
        self._ready: dict[Any, Ready] = {}
        self._changed: list[dict[str, float]] = [{} for _ in range(count)]
        self._links: list[Connection | None] = [None] * count
        self._now = [Ready(None, None, (0.0, 0.0, 0.0), 0, "", INTERVAL_US)] * count
        self._pose: Pose | None = None
        self._core: Core | None = None
        if gcs is not None:
            try:
                self._gcs = open_link(gcs)
            except LinkAddressError as error:
                raise EnvOptionError(f"gcs: {error}") from None
        if self._in_process:
            self._link(0)  # now, so that options that cannot be taken are refused here

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """The kind's own: see ``autopilot_kinds``."""
        return self.kind.action(form, setpoint)

    # ------------------------------------------------------------------ episodes

    def set_figure(self, index: int, name: str, value: float) -> None:
        """See ``Robot``."""
        self._changed[index][name] = value

    def reset(self, index: int, pose: Pose, seed: int) -> None:
        """See ``Robot``."""
        if self._in_process:
            ready = self._restored(pose, tuple(sorted(self._changed[index].items())))
            link = self._link(index)
            self._put(index, ready)
            link.simulation.reseed(seed)
        elif self._choice is not None:
            self._reset_foreign(self._choice, index, pose, seed)
        else:
            self._reset_remote(pose, seed)
        self.collided[index] = 0
        self._read(index)

    def _reset_remote(self, pose: Pose, seed: int) -> None:
        if self._pose not in (None, pose):
            raise EnvOptionError(f"connection {self._options['connection']!r}: the vehicle starts where it was started")
        self._pose = pose
        try:
            link = self._links[0]
            if link is None:
                link = connect(self._options["connection"], self.scan.shape[1], self._options["patience"])
                link.heard.angles = self.angles
                self._links[0] = link
            reboot(link)
            origin = self._prepare(link, pose)
            if isinstance(link, Lockstep):
                link.reseed(seed)
        except LinkLostError:
            self.close()
            raise
        self._now[0] = Ready(None, None, origin, self._time_us(link), "", INTERVAL_US)

    def _reset_foreign(self, choice: Choice, index: int, pose: Pose, seed: int) -> None:
        figures = self._changed[index]
        airframe = self.airframe.changed(**figures) if figures else self.airframe
        link, self._links[index] = self._links[index], None
        try:
            found = foreign.begin(choice, self._options, link, airframe, self.world, pose, seed)
            self._links[index] = found
            found.heard.angles = self.angles
            origin = self._prepare(found, pose)
        except LinkLostError:
            self.close()
            raise
        self._now[index] = Ready(None, None, origin, self._time_us(found), "", INTERVAL_US)

    def _restored(self, pose: Pose, figures: tuple[tuple[str, float], ...]) -> Ready:
        """The state after take-off at a pose; found once."""
        key = (pose, figures)
        ready = self._ready.get(key)
        if ready is None:
            simulation = self._simulation(pose, figures)
            link = InProcess(simulation, self.scan.shape[1])
            link.heard.angles = self.angles
            origin = self._prepare(link, pose)
            ready = Ready(simulation.snapshot(), link.heard.memory(), origin, simulation.time_us, "", INTERVAL_US)
            link.close()
            if len(self._ready) >= _MOST_READY:
                del self._ready[next(iter(self._ready))]
            self._ready[key] = ready
        return ready

    def _simulation(self, pose: Pose | None = None, figures: Sequence[tuple[str, float]] = ()) -> Simulation:
        options = self._options
        start = None if pose is None else (*pose[:3], math.degrees(pose[3]))
        try:
            simulation = Simulation(
                self.airframe.changed(**dict(figures)) if figures else self.airframe,
                world=self.world, start=start, home=options["home"], params=options["params"], core=self._core,
                physics=options["physics"],
            )  # fmt: skip
        except (OptionError, AirframeError, EngineError, ParameterError) as error:
            raise EnvOptionError(str(error)) from None
        if simulation.unknown_parameters:
            raise unknown("parameter", simulation.unknown_parameters[0], simulation.firmware.table.names())
        if options["physics"] == NATIVE:
            self._core = simulation.core
        return simulation

    def _link(self, index: int) -> InProcess:
        link = self._links[index]
        if link is None:
            simulation = self._simulation()
            link = self._links[index] = InProcess(simulation, self.scan.shape[1])
            link.heard.angles = self.angles
            if index == 0 and self._options["gcs"] is not None:
                simulation.bridge.add_link(self._gcs)
        assert isinstance(link, InProcess)
        return link

    def _prepare(self, link: Connection, pose: Pose) -> tuple[float, float, float]:
        """Get ready; returns NED of the local origin in the world."""
        take_off = self._options["take_off"] if self.airframe.kind == "copter" else 0.0
        heard = link.heard
        if self.kind is PX4_KIND:
            px4.prepare(link, take_off)
        else:
            prepare(link, self.kind.guided, take_off, lambda: self._send(link, setpoints.override(_AT_REST, heard, ())))
        assert heard.origin is not None
        lat, lon = (round(1e7 * angle) for angle in self._options["home"][:2])
        north, east = offset_ne(lat, lon, *heard.origin[:2])
        return north, east, -pose[2]

    @staticmethod
    def _time_us(link: Connection) -> int:
        if isinstance(link, InProcess):
            return link.simulation.time_us
        if isinstance(link, Foreign):
            return link.time_us
        return 1000 * (link.time_ms if isinstance(link, Lockstep) else int(link.heard.position[0]))

    # ------------------------------------------------------------------ steps

    def apply(self, setpoint: Setpoint, commands: Floats) -> None:
        """See ``Robot``."""
        self._setpoint, self._commands = setpoint, commands

    def advance(self, seconds: float, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """See ``Robot``."""
        us = round(1e6 * seconds)
        try:
            for index in range(self.count) if rows is None else np.flatnonzero(rows).tolist():
                self._step(index, us)
        except LinkLostError:
            self.close()
            raise

    def _step(self, index: int, us: int) -> None:
        link, now, setpoint = self._links[index], self._now[index], self._setpoint
        if link is None:
            raise LinkLostError(f"{self._where} is not open; reset() opens it")
        heard = link.heard
        interval_us = min(math.gcd(ALIGN_US, us), link.longest_interval_us)
        if now.setpoint != setpoint.name or now.interval_us != interval_us:
            now = self._change(link, now, setpoint.name, interval_us)
            self._now[index] = now
        kind, payload = self.kind.encode[setpoint.name](self._commands[index].tolist(), heard, now.origin)
        link.client.send_payload(kind, payload)
        hits, scans, goal_ms = heard.hits, heard.scans, heard.position[0] + us // 1000
        link.run(us)
        if link.is_exact:
            for _ in range(_TRIES):
                if heard.position[0] == heard.attitude[0] == goal_ms and heard.scans > scans:
                    break
                hear_again(link)
            else:
                raise LinkLostError(f"{link.name}: the vehicle's telemetry is not of this step: has it been rebooted?")
        self.collided[index] = heard.hits > hits
        self._read(index)

    def _change(self, link: Connection, now: Ready, setpoint: str, interval_us: int) -> Ready:
        """Another mode, other intervals: before the first step of an episode."""
        if now.interval_us != interval_us:
            set_intervals(link, interval_us)
        if now.setpoint != setpoint:
            set_mode(link, self.kind.modes[setpoint])
        return Ready(None, None, now.origin, now.began_us, setpoint, interval_us)

    @staticmethod
    def _send(link: Connection, made: setpoints.Message) -> None:
        link.client.send_payload(*made)

    def _read(self, index: int) -> None:
        """What was heard, into the arrays."""
        link, now = self._links[index], self._now[index]
        assert link is not None
        heard = link.heard
        _, n, e, d, vn, ve, vd = heard.position
        heading = heard.attitude[3]
        c, s = math.cos(heading), math.sin(heading)
        origin = now.origin
        x, y, z = from_ned(origin[0] + n + self._base_along * c, origin[1] + e + self._base_along * s, origin[2] + d)
        self._state[index] = (
            x, y, z, from_heading(heading), vn * c + ve * s, vn * s - ve * c, -vd, -heard.attitude[6]
        )  # fmt: skip
        self.scan[index] = heard.scan[: self.scan.shape[1]]
        self.time[index] = 1e-6 * (self._time_us(link) - now.began_us)

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """See ``Robot``; the scan of the instant was read already."""

    def link(self, index: int) -> Connection | None:
        """The connection to a vehicle, after its first reset."""
        return self._links[index]

    def simulation(self, index: int) -> Simulation:
        """A vehicle in process itself, to look at what MAVLink does not tell."""
        return self._link(index).simulation

    def photograph(self, index: int, width: int, height: int) -> Any:
        """A picture by the renderer of the vehicle's physics; None when it has none."""
        if not self._in_process:
            return None
        plant = self._link(index).simulation.plant
        return plant.engine.render(width, height) if isinstance(plant, LocalPlant) and plant.engine else None

    # ------------------------------------------------------------------ other times

    def snapshot(self, index: int) -> Any:
        """See ``Robot``."""
        link, now = self._links[index], self._now[index]
        if not isinstance(link, InProcess):
            raise EnvOptionError(f"{self._where}: only vehicles in process have snapshots")
        return Ready(
            link.simulation.snapshot(), link.heard.memory(), now.origin, now.began_us, now.setpoint, now.interval_us
        )

    def restore(self, index: int, snapshot: Any) -> None:
        """See ``Robot``."""
        if not self._in_process:
            raise EnvOptionError(f"{self._where}: only vehicles in process have snapshots")
        if not isinstance(snapshot, Ready):
            raise EnvOptionError(f"{snapshot!r} is no snapshot of a vehicle")
        self._put(index, snapshot)
        self.collided[index] = 0
        self._read(index)

    def _put(self, index: int, ready: Ready) -> None:
        link = self._link(index)
        try:
            link.simulation.restore(ready.simulation)
        except OptionError as error:
            raise EnvOptionError(f"snapshot cannot be restored: {error}") from None
        link.client.link.receive()
        link.heard.recall(ready.heard)
        self._now[index] = ready

    @property
    def _where(self) -> str:
        if self._choice is not None:
            return f"autopilot {self._choice.name}"
        return f"connection {self._options['connection']!r}"

    def close(self) -> None:
        """See ``Robot``."""
        for index, link in enumerate(self._links):
            if link is not None:
                link.close()
            self._links[index] = None

    def __getstate__(self) -> dict[str, Any]:
        if not self._in_process:
            raise TypeError(f"an environment on {self._where} cannot be pickled")
        kept = [None if link is None else self.snapshot(i) for i, link in enumerate(self._links)]
        return {"options": self._options, "kept": kept, "changed": self._changed, "collided": self.collided}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(**state["options"])  # type: ignore[misc]
        self._changed = state["changed"]
        for index, kept in enumerate(state["kept"]):
            if kept is not None:
                self.restore(index, kept)
        self.collided[:] = state["collided"]


ErleRover = partial(AutopilotRobot, frame="erle_rover")
ErleCopter = partial(AutopilotRobot, frame="erle_copter")
