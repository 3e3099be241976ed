# SPDX-License-Identifier: BSD-3-Clause
"""Several vehicles in one world: they see each other by lidar and range-finder, collide, and share the wind.

Each is a ``Simulation`` of its own, of any kind. They go on in slices of simulated time, at whose ends they show
themselves to each other (``sitl.physics.native.traffic``). Within a slice none depends on another one, so neither the
order in which they are advanced nor the steps of the caller change a bit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, Unpack

import numpy as np

from .bridge.frame import Splitter
from .bridge.links.inprocess import InProcessLink
from .bridge.router import Router
from .bridge.services.parameter_protocol import ParameterService
from .core import rng
from .core.compile import Progress
from .core.constants import TICK_US
from .core.elementary import cos, hypot, sin
from .core.record_reader import RecordReader, locate
from .core.vectors import Vec3
from .deprecation import warn
from .errors import OptionError
from .physics.native.records import Wind
from .physics.native.traffic import MOVER_SIZE, NOBODY, PUSHED, SLICE_US, Mover, SharedWind, let_meet, stir_wind
from .plants.lidar import Company
from .plants.local import LocalPlant
from .plants.surroundings import Surroundings, start_pose
from .scenario import Options, Scenario, StartPose
from .simulation import Simulation, Snapshot
from .vehicle.core_entry import bind_unit
from .vehicles import Airframe
from .worlds import Start, World
from .worlds import load as load_world

Array = np.ndarray[Any, Any]
Frame = str | Airframe | Scenario
Pose = tuple[float, float, float, float]
SPACING = 4.0
"""Of the grid on which vehicles start [m]."""
MOST = 250
"""Vehicles of a swarm: each has a system id of its own."""
RADIO = {"POSITION": 10}
"""Stream groups [Hz] that each vehicle sends to the others."""
LEADS = ("GLOBAL_POSITION_INT", "FOLLOW_TARGET")
"""What they hear of it."""
WIND = ("SPD", "DIR", "TURB", "TC", "T", "T_ALT", "T_COEF", "DIR_Z")
"""SIM_WIND_ parameters, which are the same for all."""
_WIND_BYTES = Wind.fields["steady"].offset
"""What they say stands at the beginning of the record."""
_SHOW, _TAKE = 1, 0


def plain(heading: float) -> World:
    """A world without solids; vehicles start at its origin with a heading [deg]."""
    return World("plain", (), (Start("origin", (0.0, 0.0, 0.0), math.radians(-heading)),), "Open ground without end.")


def grid(count: int, spacing: float, origin: Pose) -> list[Pose]:
    """Start poses (x, y, z [m], yaw [deg]) in rows, one beside the other to the right, then behind.

    Args:
        count: how many.
        spacing: from one to the next [m].
        origin: pose of the first one.
    """
    x, y, z, yaw = origin
    columns = math.ceil(math.sqrt(count))
    c, s = cos(math.radians(yaw)), sin(math.radians(yaw))
    poses = []
    for k in range(count):
        back, right = spacing * (k // columns), spacing * (k % columns)
        poses.append((x - back * c + right * s, y - back * s - right * c, z, yaw))
    return poses


@dataclass(frozen=True)
class SwarmSnapshot:
    """All of a swarm at one time, for ``Swarm.restore``."""

    vehicles: tuple[Snapshot, ...]
    movers: bytes
    shown: bytes
    air: bytes
    wind: bytes
    time_us: int
    near: tuple[int, ...]
    said: tuple[bytes, ...]
    to_hear: tuple[bytes, ...]


class Swarm:
    """Vehicles in one world; see docs/swarm.md.

    Vehicle k has MAVLink's system id k + 1 and noise of its own: that of ``seed`` + k.

    Args:
        frames: what each vehicle is: airframe name, path of a file that defines one, an Airframe, or a whole
            ``Scenario``, of which home, world and seed do not count; or one of these for all ``count`` vehicles.
        count: number of vehicles, 1 .. 250; None: as many as ``frames``.
        starts: a start pose for each: name of one of the world's, or x, y, z [m], yaw [deg] in the world's frame; None:
            on a grid, the first one at ``start``, or where the world has its vehicles start.
        spacing: of the grid [m].
        progress: called for each unit that is compiled.
        options: as of ``Simulation``, for all. Without a world they are on a plain without end, with home's heading.

    Raises:
        OptionError: a number of vehicles or start poses that cannot be; two start poses are too near to each other, or
            one is in a solid; the physics is not native; and what ``Simulation`` raises.
    """

    def __init__(
        self,
        frames: Frame | Sequence[Frame] = "erle_copter",
        count: int | None = None,
        *,
        starts: Sequence[StartPose] | None = None,
        spacing: float = SPACING,
        progress: Progress | None = None,
        **options: Unpack[Options],
    ) -> None:
        self.scenarios = _scenarios(frames, count, starts, spacing, dict(options))
        """What each vehicle is, and where it starts."""
        _check_apart(self.scenarios)
        self.vehicles = [Simulation(scenario, progress=progress) for scenario in self.scenarios]
        """They are advanced together, by the swarm alone."""
        self.router = Router(self.vehicles)
        """Links that vehicles share: ``router.add_link(link)``."""
        self.time_us = 0
        """Simulated time since the start of the swarm [us]."""
        n = len(self.vehicles)
        self.order: Sequence[int] = range(n)
        """In which vehicles are advanced within a slice: it changes nothing."""
        self._movers, self._shown = Mover.fleet(n), Mover.fleet(n)
        """What they meet by, and what their sensors have of them: it changes at the end of a slice only."""
        self._near: tuple[int, ...] = ()
        """Those that may touch another one in this slice."""
        self._meet = [self._meeting(k, progress) for k in range(n)]
        self._air = SharedWind.fleet(1)
        self._winds = [vehicle.v.physics.wind for vehicle in self.vehicles]
        self._gusts = SharedWind.of(self._air, 0)
        rng.seed(self._gusts.rng, self.vehicles[0].seed)
        self._wind_at = [self._wind_bytes(vehicle) for vehicle in self.vehicles]
        self._set_wind_of(0)
        self._follows = [_reads_follow(vehicle) for vehicle in self.vehicles]
        self._radios = [InProcessLink("radio") for _ in range(n)]
        self._said, self._to_hear = [b""] * n, [b""] * n
        for vehicle, radio in zip(self.vehicles, self._radios, strict=True):
            vehicle.bridge.add_link(radio)
            vehicle.bridge.stream_to(radio, RADIO)
        self._exchange()

    def _meeting(self, k: int, progress: Progress | None) -> Callable[[int], None]:
        """Let vehicle ``k`` know the others; its unit ``meet``."""
        vehicle, plant = self.vehicles[k], self.vehicles[k].plant
        if not (isinstance(plant, LocalPlant) and plant.runs_in_core):
            raise OptionError(f"vehicles of a swarm are on native physics, not on {vehicle.physics}")
        if vehicle.kind.meet is None:
            raise OptionError(f"vehicles of kind {vehicle.kind.name} cannot share a world: the kind has no unit for it")
        plant.join(Company(self._shown.ctypes.data, len(self.vehicles), k))
        unit: Callable[..., None] = bind_unit(vehicle.kind.meet, vehicle.kind, vehicle.fleet, vehicle.index, progress)
        mover = self._movers.ctypes.data + k * MOVER_SIZE
        return lambda shows: unit(mover, shows)

    @staticmethod
    def _wind_bytes(vehicle: Simulation) -> memoryview:
        """Where its settings of the wind are in memory."""
        at = locate(vehicle.fleet.dtype, "physics.wind.speed")[0]
        return memoryview(vehicle.fleet.view("u1"))[at : at + _WIND_BYTES]  # type: ignore[arg-type]

    def __len__(self) -> int:
        return len(self.vehicles)

    def __getitem__(self, number: int) -> Simulation:
        return self.vehicles[number]

    # ------------------------------------------------------------------ time

    def advance(self, seconds: float) -> None:
        """Advance all by a simulated time, rounded up to whole ticks of 2.5 ms.

        Raises:
            OptionError: ``seconds`` is negative or not a finite number.
        """
        if not (isinstance(seconds, Real) and 0.0 <= seconds < math.inf):
            raise OptionError(f"cannot advance by {seconds!r} s: a number from 0 on is needed")
        self.advance_to(self.time_us + round(seconds * 1e6))

    def advance_to(self, time_us: int) -> None:
        """Advance all to the first tick at or after a simulated time; what clients sent is read at the beginning."""
        goal = max(-(-time_us // TICK_US) * TICK_US, self.time_us)
        self.router.receive()
        while True:
            end = min(self.time_us - self.time_us % SLICE_US + SLICE_US, goal)
            self._go(end)
            if end > self.time_us and end % SLICE_US == 0:
                self.time_us = end
                self._exchange()
            self.time_us = end
            self.router.flush()
            if end == goal:
                return

    @property
    def received(self) -> int:
        """How often clients on links of the router have said something, so far."""
        return self.router.received

    @property
    def heard(self) -> int:
        """Deprecated: ``received``."""
        warn("Swarm.heard", since="0.2", removed_in="0.4", instead="Swarm.received")
        return self.received

    def wait(self, seconds: float) -> bool:
        """Sleep until a client on one of these links says something, at most ``seconds`` of wall time."""
        return self.router.wait(seconds)

    def receive(self) -> None:
        """Hear clients, and answer what needs no time."""
        self.router.receive()
        for vehicle in self.vehicles:
            vehicle.bridge.receive()
        self.router.flush()

    def _go(self, end: int) -> None:
        """Advance all within a slice; those that may touch each other tick by tick."""
        for k, data in enumerate(self._to_hear):
            if data:
                self._radios[k].send(data)
                self._to_hear[k] = b""
        near = [k for k in self.order if k in self._near]
        for k in self.order:
            self.vehicles[k].advance_to(self.time_us if k in self._near else end)
        if near:
            for time_us in range(self.time_us + TICK_US, end + 1, TICK_US):
                for k in near:
                    self.vehicles[k].advance_to(time_us)
                self._let_meet(near, True)
        for k, radio in enumerate(self._radios):
            self._said[k] += radio.receive()

    def _let_meet(self, which: Iterable[int], only_near: bool) -> int:
        for k in which:
            self._meet[k](_SHOW)
        found = let_meet(self._movers.ctypes.data, len(self.vehicles), only_near)
        if found == PUSHED:
            for k in which:
                self._meet[k](_TAKE)
        return found

    def _exchange(self) -> None:
        """The end of a slice: vehicles see each other, meet, and hear each other; gusts change."""
        found = self._let_meet(self.order, False)
        self._near = () if found == NOBODY else tuple(np.flatnonzero(self._movers["is_near"]).tolist())
        self._shown[:] = self._movers
        self._share_wind()
        self._broadcast()

    def _share_wind(self) -> None:
        for k, settings in enumerate(self._wind_at):
            if settings != self._wind:
                self._set_wind_of(k)
                break
        gusts = self._gusts
        if gusts.wind.turbulence > 0.0 or gusts.wind.gust != Vec3(0.0, 0.0, 0.0):
            stir_wind(self._air.ctypes.data)
        gust = gusts.wind.gust
        for wind in self._winds:
            wind.gust = gust

    def _set_wind_of(self, number: int) -> None:
        """The wind of one vehicle is set: it is that of all."""
        lead = self.vehicles[number].parameters
        for k, vehicle in enumerate(self.vehicles):
            for name in (f"SIM_WIND_{ending}" for ending in WIND):
                if k != number and vehicle.parameters[name] != lead[name]:
                    vehicle.bridge.get(ParameterService).set(name, lead[name])
        self._wind = bytes(self._wind_at[number])
        self._gusts.wind.turbulence = self._winds[number].turbulence
        self._gusts.wind.time_constant = self._winds[number].time_constant

    def _broadcast(self) -> None:
        """What vehicles said by radio is heard by those that follow (FOLL_ENABLE)."""
        hearers = [k for k, follows in enumerate(self._follows) if follows()]
        if hearers:
            frames = [
                b"".join(frame.raw for frame in Splitter().feed(said) if frame.kind.name in LEADS)
                for said in self._said
            ]
            for k in hearers:
                self._to_hear[k] += b"".join(data for j, data in enumerate(frames) if j != k)
        self._said = [b""] * len(self.vehicles)

    # ------------------------------------------------------------------ other times

    def snapshot(self) -> SwarmSnapshot:
        """A copy of everything in the swarm; links and clients are not in it."""
        return SwarmSnapshot(
            tuple(vehicle.snapshot() for vehicle in self.vehicles),
            self._movers.tobytes(), self._shown.tobytes(), self._air.tobytes(), self._wind,
            self.time_us, self._near, tuple(self._said), tuple(self._to_hear),
        )  # fmt: skip

    def restore(self, snapshot: SwarmSnapshot) -> None:
        """Put all back to a snapshot of this swarm; the same commands then give the same bytes again.

        Raises:
            OptionError: it is of another swarm.
        """
        if len(snapshot.vehicles) != len(self.vehicles):
            raise OptionError(f"the snapshot is of {len(snapshot.vehicles)} vehicles, the swarm has {len(self)}")
        for vehicle, state in zip(self.vehicles, snapshot.vehicles, strict=True):
            vehicle.restore(state)
        for array, held in ((self._movers, snapshot.movers), (self._shown, snapshot.shown), (self._air, snapshot.air)):
            array[:] = np.frombuffer(held, array.dtype)
        self._wind, self.time_us, self._near = snapshot.wind, snapshot.time_us, snapshot.near
        self._said, self._to_hear = list(snapshot.said), list(snapshot.to_hear)

    def reseed(self, seed: int) -> None:
        """Other noise of all sensors, and other gusts, from now on: as of a swarm of this seed."""
        for k, vehicle in enumerate(self.vehicles):
            vehicle.reseed(seed + k)
        rng.seed(self._gusts.rng, seed)

    def close(self) -> None:
        """Close links, logs and physics."""
        self.router.close()
        for vehicle in self.vehicles:
            vehicle.close()


def _reads_follow(vehicle: Simulation) -> Callable[[], float]:
    return RecordReader(vehicle.fleet, vehicle.index).field("autopilot.params.FOLL.ENABLE")


def _scenarios(
    frames: Frame | Sequence[Frame],
    count: int | None,
    starts: Sequence[StartPose] | None,
    spacing: float,
    options: dict[str, Any],
) -> list[Scenario]:
    """What each vehicle is, with its position, seed and system id."""
    each = [frames] * (1 if count is None else count) if isinstance(frames, Frame) else list(frames)
    if not 1 <= len(each) <= MOST or (count is not None and len(each) != count):
        raise OptionError(
            f"count = {count}, {len(each)} frames: a swarm has 1 .. {MOST} vehicles, and a frame for each or for all"
        )
    common = Scenario.of(None, **options)
    world = load_world(common.world) if common.world is not None else plain(common.home_or_default[3])
    given = [Scenario.of(frame) if isinstance(frame, Scenario) else Scenario.of(frame, **options) for frame in each]
    if starts is None:
        if not (isinstance(spacing, int | float) and 0.0 < spacing < math.inf):
            raise OptionError(f"spacing = {spacing!r}; a number of metres above 0 is needed")
        x, y, z, yaw = start_pose(world, common.start, given[0].airframe.name)
        starts = grid(len(given), spacing, (x, y, z, math.degrees(yaw)))
    if len(starts) != len(given):
        raise OptionError(f"{len(starts)} start poses for {len(given)} vehicles: each needs one")
    seed, found = common.seed_or_default, []
    for k, (scenario, start) in enumerate(zip(given, starts, strict=True)):
        params = scenario.parameters | {"MAV_SYSID": 1.0 + k}
        own = {"home": common.home, "world": world, "start": start, "seed": seed + k, "params": params}
        found.append(replace(scenario, **own))  # type: ignore[arg-type]
    return found


def _check_apart(scenarios: Sequence[Scenario]) -> None:
    """Whether no vehicle stands in another one at its start.

    Raises:
        OptionError: two do.
    """
    placed: list[tuple[float, float, float]] = []
    for k, scenario in enumerate(scenarios):
        airframe = scenario.airframe
        assert isinstance(scenario.world, World)
        around = Surroundings(scenario.world, scenario.start, airframe)
        along = np.abs(np.asarray(airframe.value("contact_along"), float))[: int(airframe.value("contact_discs") or 1)]
        reach = float(along.max()) + float(airframe.value("contact_radius"))
        north, east, _ = around.position
        for j, (other_north, other_east, other_reach) in enumerate(placed):
            away = hypot(north - other_north, east - other_east)
            if away < reach + other_reach:
                raise OptionError(
                    f"start of vehicle {k} at x {around.start[0]:g}, y {around.start[1]:g} m: it is {away:.2f} m from "
                    f"that of vehicle {j}; {reach + other_reach:.2f} m are needed"
                )
        placed.append((north, east, reach))
