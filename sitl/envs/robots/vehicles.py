# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with an autopilot behind a MAVLink connection: the base class of in-process, socket and foreign ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, ClassVar

from sitl.autopilot.params.parm_files import Given
from sitl.bridge.dialect import MessageType
from sitl.client.connection import Connection
from sitl.core.geodesy import offset_ne
from sitl.foreign.choice import NATIVE as OURS
from sitl.physics.engines import NATIVE, backends
from sitl.scenario import DEFAULT_HOME, Home, Scenario
from sitl.simulation import Simulation
from sitl.vehicle.faults import Failure
from sitl.vehicles import Airframe
from sitl.vehicles.airframe import Value
from sitl.vehicles.properties.property import Property
from sitl.worlds import World

from ..mavlink import px4, target_messages
from ..mavlink.guard import Guard, Watch
from ..mavlink.last_messages import StepTelemetry
from ..mavlink.preparation import INTERVAL_US, REBOOT, prepare
from ..options import EnvOptionError
from .kind import RobotKind
from .robot import Floats, Pose
from .true_state import true_reports, true_states
from .wind import PROPERTIES

INPROCESS = "inprocess"
_AT_REST = (1500.0, 1500.0, 1500.0, 1500.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class EpisodeState:
    """State of one vehicle's episode; picklable. As a snapshot it has the simulation and the telemetry, too."""

    simulation: Any
    """Snapshot of the simulation; None while it runs."""
    telemetry: Any
    """Snapshot of the telemetry received; None while it runs."""
    origin: tuple[float, float, float]
    """Origin of the vehicle's local position in the world: north, east, down [m]."""
    began_us: int
    """Simulated time of the start of the episode [us]."""
    setpoint: str
    """Kind of set-point that the flight mode takes; "" before the first."""
    interval_us: int
    """Interval of telemetry [us]."""


NOT_STARTED = EpisodeState(None, None, (0.0, 0.0, 0.0), 0, "", INTERVAL_US)


@dataclass(frozen=True)
class AutopilotOptions:
    """Options of vehicles with an autopilot.

    Args:
        frame: airframe with a lidar: a name, a .toml or .py file, or an ``Airframe``.
        connection: "inprocess", or the address of a vehicle: "udp:HOST:PORT", "udpout:HOST:PORT", "tcp:HOST:PORT".
            A vehicle started with ``sitl run --lockstep`` advances by exactly one step at a time; others run in real
            time.
        take_off: height at which a copter hovers at the start of an episode, 0.5 .. 100 [m].
        home: latitude, longitude [deg], altitude [m] of the world's origin; the heading is not used.
        params: parameter values by ArduPilot's names, or a file of parameters, for vehicles in process or with a
            foreign autopilot.
        gcs: address of a ground station that receives the first vehicle's telemetry, as in ``sitl run --out``; None:
            none.
        patience: wall time without an answer after which a connection counts as lost [s].
        physics: engine for vehicles in process or with a foreign autopilot, e.g. "native", "pybullet" (see
            ``sitl.simulation.Simulation``).
        autopilot: "native", or a foreign autopilot on our physics, by its program or the address of its MAVLink:
            "ardupilot:PROGRAM", "ardupilot:tcp:HOST:PORT" (``sitl.foreign.choice``). It is started or rebooted for
            each episode, and has no snapshots. With ``connection``: what runs there, "ardupilot" (as "native") or
            "px4".
        autopilot_path: path of the program, when ``autopilot`` does not give it.
        reset: what ``reset()`` does to a vehicle that runs elsewhere: "reboot": it is disarmed by force and rebooted,
            if it proves to be a simulator; "force": the same, whatever it is; "none": ``reset()`` waits until it is
            armed, in GUIDED, at rest, and in the air if it flies; "return": the same, and it goes back to where the
            first episode began. See ``envs.mavlink.preparation``.
        wait: how long "none" and "return" wait [s].
        guard: limits of the agent on a vehicle that runs elsewhere: a ``guard.Guard``, or a dict of its arguments;
            False: none. None: ``Guard()``, but for what proves to be a simulator.
        threads: that advance vehicles in process on native physics; their number changes no bit of the result.
        begin: how vehicles in process on native physics come to the start of an episode: "move" (one vehicle boots and
            takes off at the environment's start pose, once, and is moved to others, with other properties), or "boot"
            (it boots and takes off at each start pose, with each set of properties). Others always boot.
        boots: number of prepared boots, 1 .. 1024, one of which each episode begins with, by its seed: biases of IMU
            and compass and the errors of the estimate are those of that boot; the slow error of the receiver is
            drawn for each episode. With ``begin="boot"`` each episode has a boot of its own. 1: one boot with seed
            0, with which all episodes begin: the estimate's error at the start is the same constant in all of them.
        sensors: what tells the vehicle where it is: "gps" (as the airframe has it), "rtk", "mocap", "uwb" or
            "ardupilot" (``sitl.vehicles.receivers``).
    """

    frame: str | Airframe = "erle_rover"
    connection: str = INPROCESS
    take_off: float = 1.0
    home: Home = DEFAULT_HOME
    params: Given | None = None
    gcs: str | None = None
    patience: float = 10.0
    physics: str = NATIVE
    autopilot: str = OURS
    autopilot_path: str | Path | None = None
    reset: str = REBOOT
    wait: float = 60.0
    guard: Guard | Mapping[str, Any] | bool | None = None
    threads: int = 1
    begin: str = "move"
    boots: int = 64
    sensors: str = "gps"

    @classmethod
    def names(cls) -> list[str]:
        """Names of all."""
        return [each.name for each in fields(cls)]


@dataclass(frozen=True)
class VehicleSetup:
    """What vehicles are made from."""

    options: AutopilotOptions
    count: int
    """Number of vehicles."""
    airframe: Airframe
    kind: RobotKind
    world: World
    scenario: Scenario
    """What is simulated, without start and seed of an episode."""
    angles: Floats
    """Angles of the lidar's readings, counter-clockwise from ahead, shape (readings,) [rad]."""
    arrays: Any
    """What the environment knows of each vehicle (``mavlink.compiled.RobotArrays``)."""
    wanted: list[MessageType] = field(default_factory=list)
    """Messages that vehicles send with each step besides position, attitude and scan (``senses.REPORTS``)."""

    def inbox(self) -> StepTelemetry:
        """What takes in the messages of a vehicle."""
        inbox = StepTelemetry(len(self.angles), self.wanted)
        inbox.angles = self.angles
        return inbox


class Vehicles(ABC):
    """``setup.count`` vehicles and the connections to them.

    Args:
        setup: what they are made from.

    Raises:
        EnvOptionError: an option is refused.
    """

    simulates: ClassVar[bool] = True
    """Whether the physics is in this process, so that properties can be changed and the truth is known."""
    has_snapshots: ClassVar[bool] = False
    takes_threads: ClassVar[bool] = False
    min_step: ClassVar[float] = 0.005
    """An environment's step is a whole multiple of this, or of the autopilot's loop period when that is longer [s]."""

    def __init__(self, setup: VehicleSetup) -> None:
        self.setup, self.options = setup, setup.options
        self.worlds = [setup.world] * setup.count
        """The world of each vehicle."""
        physics, count = self.options.physics, setup.count
        if physics not in backends() or (physics != NATIVE and not self.simulates):
            raise EnvOptionError(f"physics {physics!r}: it is one of {', '.join(backends())}, of a vehicle in process")
        if self.options.threads != 1 and not self.takes_threads:
            raise EnvOptionError(
                f"threads = {self.options.threads!r}: only vehicles in process on native physics have any"
            )
        self.threads = self.options.threads
        """See ``AutopilotOptions``."""
        self.links: list[Connection | None] = [None] * count
        """Connection to each vehicle; None before it is needed."""
        self.changed: list[dict[str, Value]] = [{} for _ in range(count)]
        """Changed properties of each vehicle: name -> value, in the property's unit; vectors are tuples."""
        self.watch: Watch | None = None
        """The guard of a vehicle that runs elsewhere."""
        self.scans_used = True
        """Whether anything reads the lidars."""
        self.lets_down = 0.0
        """Height below which a vehicle that runs elsewhere is put down; 0: it is not [m]."""
        self.base: Pose | None = None
        """Where a vehicle is prepared that is moved to other starts; None: at the world's start pose."""

    @property
    def extra_properties(self) -> Mapping[str, Property]:
        """Properties besides the airframe's that can be changed."""
        return PROPERTIES if self.simulates and self.setup.kind.feels_wind else {}

    def enter(self, index: int, world: World) -> None:
        """One vehicle's next episode is in this world.

        Raises:
            EnvOptionError: it stays in the world that it was made in, or cannot start in this one.
        """
        raise EnvOptionError(
            f"world {world.name!r}: a vehicle of {self.where} stays in the world {self.setup.world.name!r} that it was "
            "made in; only vehicles whose physics is in this process change worlds between episodes"
        )

    @property
    @abstractmethod
    def where(self) -> str:
        """The option that selects these vehicles, for messages."""

    @abstractmethod
    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        """Bring one vehicle to the start of an episode, with an open connection.

        Args:
            index: index of the vehicle.
            pose: x, y, z [m], yaw [rad] in the world.
            seed: seed of the sensors' noise.

        Raises:
            EnvOptionError: an option is refused.
            LinkLostError: the connection is lost.
            NotReadyError: the vehicle does not arm or take off.
        """

    @abstractmethod
    def time_us(self, index: int) -> int:
        """Simulated time of one vehicle; it is continuous within an episode [us]."""

    def snapshot(self, index: int, now: EpisodeState) -> EpisodeState:
        """A snapshot of one vehicle and the state of its episode."""
        raise EnvOptionError(f"{self.where}: only vehicles in process have snapshots")

    def restore(self, index: int, state: EpisodeState) -> None:
        """Restore one vehicle from a snapshot."""
        raise EnvOptionError(f"{self.where}: only vehicles in process have snapshots")

    def simulation(self, index: int) -> Simulation:
        """A simulation in the state of one vehicle. It may be a copy: what is done to that does not reach the vehicle.

        Raises:
            EnvOptionError: the vehicle is in another process.
        """
        raise EnvOptionError(f"{self.where}: only vehicles in process can be looked into")

    def view(self, index: int) -> Any:
        """The record of one vehicle (``sitl.vehicle.record``), for values that MAVLink does not send; to be read only.

        Raises:
            EnvOptionError: the vehicle is in another process.
        """
        return self.simulation(index).v

    def true_states(self, ahead: float, out: Floats) -> None:
        """Write where the vehicles really are: see ``truth.write_truth``. Rows of vehicles without an episode may be
        left alone.

        Raises:
            EnvOptionError: the physics of a vehicle is in another process.
        """
        for index in range(self.setup.count):
            physics = self.physics(index)
            if physics is not None:
                true_states(physics["body"], ahead, out[index : index + 1])
                out[index, 2] += self.worlds[index].floor_z  # bodies count from the floor

    def true_reports(self, out: Floats) -> None:
        """Write what the vehicles would measure without errors: see ``truth.write_true_reports``. Rows of vehicles
        without an episode may be left alone.

        Raises:
            EnvOptionError: the physics of a vehicle is in another process.
        """
        for index in range(self.setup.count):
            physics = self.physics(index)
            if physics is not None:
                true_reports(physics, out[index : index + 1])

    def physics(self, index: int) -> Any:
        """The physics of one vehicle (``sitl.physics.native.records.Physics``), to be read only: an array of one
        record; None before it is needed.

        Raises:
            EnvOptionError: it is in another process.
        """
        simulation = self.simulation(index)
        return simulation.fleet[simulation.index : simulation.index + 1]["physics"]

    def fail(self, index: int, failure: Failure) -> None:
        """Let something fail in one vehicle; times count from the beginning of its next step."""
        self.simulation(index).fail(failure)

    def photograph(self, index: int, width: int, height: int) -> Any:
        """An image by the physics engine's renderer, shape (height, width, 3), uint8; None when it has no renderer."""
        return None

    def use_threads(self, threads: int) -> None:
        """Before the first episode: so many threads are to advance the vehicles, if these take any."""
        self.threads = threads

    def close(self) -> None:
        """Close all connections."""
        for index, link in enumerate(self.links):
            if link is not None:
                link.close()
            self.links[index] = None

    # ------------------------------------------------------------------ for subclasses

    def prepare(self, link: Connection, pose: Pose) -> tuple[float, float, float]:
        """Arm and take off a vehicle that has just booted; returns its local origin in the world: north, east, down
        [m]."""
        kind, inbox = self.setup.kind, link.inbox
        take_off = self.options.take_off if kind.takes_off else 0.0

        def hold_sticks() -> None:
            link.endpoint.send_payload(*target_messages.override(_AT_REST, inbox, ()))

        if kind.prepares is not None:
            kind.prepares(link, take_off)
        elif kind.guided == px4.OFFBOARD:
            px4.prepare(link, take_off)
        else:
            prepare(link, kind.guided, take_off, hold_sticks)
        assert inbox.origin is not None
        lat, lon = (round(1e7 * angle) for angle in self.options.home[:2])
        north, east = offset_ne(lat, lon, *inbox.origin[:2])
        return north, east, -pose[2]

    def begun(self, index: int, origin: tuple[float, float, float]) -> EpisodeState:
        """The state of an episode that starts now; ``origin``: NED [m] in the world."""
        return EpisodeState(None, None, origin, self.time_us(index), "", INTERVAL_US)
