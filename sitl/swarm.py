# SPDX-License-Identifier: BSD-3-Clause
"""Several vehicles of one kind in one world: they see each other by lidar and range-finder, collide, and share the wind.

All go on together, in slices of simulated time at whose ends they show themselves to each other
(``sitl.physics.native.traffic``). Neither the steps of the caller nor the number of threads change a bit of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np

from .bridge.frame import Splitter
from .core import rng
from .core.compile import Progress
from .core.constants import TICK_US
from .errors import OptionError
from .fleet import Fleet
from .physics.native.records import Wind
from .physics.native.traffic import MOVER_SIZE, NOBODY, PUSHED, SLICE_US, Mover, SharedWind, let_meet, stir_wind
from .plants.local import Company, LocalPlant
from .plants.surroundings import Surroundings
from .scenario import Options, Scenario, StartPose
from .simulation import Simulation, Snapshot
from .vehicle.core_entry import Core, bind_fleet_unit
from .vehicles import Airframe
from .worlds import Start, World

Array = np.ndarray[Any, Any]
SPACING = 4.0
"""Of the grid on which vehicles start [m]."""
MOST_SYSTEMS = 250
"""System ids of vehicles are 1 .. 250; later vehicles begin again with 1."""
LEADS = ("GLOBAL_POSITION_INT", "FOLLOW_TARGET")
"""Messages that vehicles on one link take from each other."""
_WIND = ("WIND_SPD", "WIND_DIR", "WIND_TURB", "WIND_TC", "WIND_T", "WIND_T_ALT", "WIND_T_COEF", "WIND_DIR_Z")
_WIND_BYTES = Wind.fields["steady"].offset
"""Settings are at the beginning of the record."""


def system_id(number: int) -> int:
    """MAVLink system id of vehicle ``number``, from 0."""
    return 1 + number % MOST_SYSTEMS


def plain(heading: float) -> World:
    """A world without solids; vehicles start at its origin with a heading [deg]."""
    yaw = math.radians(90.0 - heading) - 0.5 * math.pi  # x is north: a heading is clockwise from it
    return World("plain", (), (Start("origin", (0.0, 0.0, 0.0), yaw),), "Open ground without end.")


def grid(count: int, spacing: float, origin: tuple[float, float, float, float]) -> list[tuple[float, ...]]:
    """Start poses (x, y, z [m], yaw [deg]) in rows, one beside the other to the right, then behind.

    Args:
        count: how many.
        spacing: from one to the next [m].
        origin: pose of the first one.
    """
    x, y, z, yaw = origin
    columns = math.ceil(math.sqrt(count))
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    poses = []
    for k in range(count):
        back, right = spacing * (k // columns), spacing * (k % columns)
        poses.append((x - back * c + right * s, y - back * s - right * c, z, yaw))
    return poses


@dataclass(frozen=True)
class SwarmSnapshot:
    """All of a swarm at one time, for ``Swarm.restore_all``."""

    vehicles: tuple[Snapshot, ...]
    seen: bytes
    """What each vehicle's shell has seen (``Slot``)."""
    movers: bytes
    shown: bytes
    wind: bytes
    clock_us: int
    is_stale: bool
    said: tuple[bytes, ...]
    unread: tuple[bytes, ...]
    """Bytes to clients that they have not received."""


class Swarm(Fleet):
    """Vehicles of one kind in one world, each with one client in this process; see docs/swarms.md.

    Vehicle k has system id k + 1 and noise of its own: that of seed + k.

    Args:
        frame: as of ``Fleet``.
        count: number of vehicles.
        starts: a start pose for each: name of one of the world's, or x, y, z [m], yaw [deg] in the world's frame; None:
            on a grid, the first one where the world's start pose for this airframe is, or ``start``.
        spacing: of the grid [m].
        threads, core, progress: as of ``Fleet``.
        options: as of ``Fleet``; without a world they are on a plain without end, with home's heading.

    Raises:
        OptionError: two start poses are too near to each other, or one is in a solid; and what ``Fleet`` raises.
    """

    _kept: Array | None = None
    """What vehicles showed last, shape (count,); None while the fleet is being made."""

    def __init__(
        self,
        frame: str | Airframe | Scenario | None = None,
        count: int = 1,
        *,
        starts: Sequence[StartPose] | None = None,
        spacing: float = SPACING,
        threads: int = 1,
        core: Core | None = None,
        progress: Progress | None = None,
        **options: Unpack[Options],
    ) -> None:
        scenario = Scenario.of(frame, **options)
        if scenario.world is None:
            scenario = replace(scenario, world=plain(scenario.home_or_default[3]))
        super().__init__(scenario, count, threads=threads, core=core, progress=progress)
        if self.kind.meet is None:
            raise OptionError(f"vehicles of kind {self.kind.name} cannot share a world: the kind has no unit for it")
        plant = self.shell.plant
        assert isinstance(plant, LocalPlant) and plant.surroundings is not None and plant.rangers is not None
        self._plant, around = plant, plant.surroundings
        if starts is None:
            if not (isinstance(spacing, int | float) and 0.0 < spacing < math.inf):
                raise OptionError(f"spacing = {spacing!r}; a number of metres above 0 is needed")
            x, y, z, yaw = around.start
            starts = grid(count, spacing, (x, y, z, math.degrees(yaw)))
        if len(starts) != count:
            raise OptionError(f"{len(starts)} start poses for {count} vehicles: each needs one")
        self._around = [Surroundings(around.world, start, scenario.airframe) for start in starts]
        self._check_apart()
        self.clock_us = 0
        """Simulated time since the swarm was made [us]."""
        self._stale = False
        self._meeting = Mover.fleet(count)
        self._kept = shown = Mover.fleet(count)
        self._meet_unit = bind_fleet_unit(self.kind.meet, self.kind, self.records, progress)
        self._near: list[int] = []
        self._air = SharedWind.fleet(1)
        self._shared_wind = SharedWind.of(self._air, 0)
        rng.seed(self._shared_wind.rng, scenario.seed_or_default)
        at = self._offset("physics", "wind")
        self._wind_u1 = self._records_u1[:, at : at + _WIND_BYTES]
        self._gusts = self.records["physics"]["wind"]["gust"]
        self._follows = self.records["autopilot"]["params"]["FOLL"]["ENABLE"]
        self._said = [b""] * count
        """What each vehicle said since others heard it last."""
        self._splitters = [Splitter() for _ in range(count)]
        self._heard_to = [0] * count
        """Up to where in its port it has been heard."""
        plant.join(Company(shown.ctypes.data, count, 0))
        initial = self._states[0]
        seed = scenario.seed_or_default
        for k in range(count):
            self._boot(k, seed + k, replace(initial, record=self._records_u1[0].tobytes()) if k == 0 else None)
        self._share_wind_of(0)
        self._exchange()

    # ------------------------------------------------------------------ making it

    def _offset(self, *names: str) -> int:
        """Where a field is in a vehicle's record."""
        layout, at = self.records.dtype, 0
        for name in names:
            layout, offset = layout.fields[name][:2]  # type: ignore[index]
            at += offset
        return at

    def _check_apart(self) -> None:
        a = self.scenario.airframe
        along = np.abs(np.asarray(a.value("contact_along"), float))[: int(a.value("contact_discs") or 1)]
        least = 2.0 * (float(along.max()) + float(a.value("contact_radius")))
        places = np.array([around.position[:2] for around in self._around])
        for k in range(1, len(places)):
            away = np.hypot(*(places[:k] - places[k]).T)
            if away.min() < least:
                other, pose = int(away.argmin()), self._around[k].start
                raise OptionError(
                    f"start of vehicle {k} at x {pose[0]:g}, y {pose[1]:g} m: it is {away.min():.2f} m from that of "
                    f"vehicle {other}; {self.scenario.airframe.name} needs {least:.2f} m"
                )

    def _boot(self, number: int, seed: int, _initial: Snapshot | None) -> None:
        """Power on vehicle ``number`` at its place."""
        shell = self.shell
        self._become(number)
        self._plant.seed = seed
        shell.restore(self.snapshot(number))
        shell.v.autopilot.params.MAV.SYSID = system_id(number)
        shell.request_reboot()
        shell.advance_to(shell.time_us)
        self._link.receive()
        self._give([number], self._take())

    def _become(self, number: int) -> None:
        """Let the shell stand for vehicle ``number``."""
        plant = self._plant
        assert plant.company is not None
        plant.stand_at(self._around[number], self.scenario.seed_or_default + number)
        plant.company = plant.company._replace(number=number)
