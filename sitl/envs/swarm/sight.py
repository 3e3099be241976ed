# SPDX-License-Identifier: BSD-3-Clause
"""What agents of a swarm see: pictures of the world and of each other, and scans of their lidars."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from ...simulation import Simulation
from ...swarm import Swarm
from ...worlds import World
from ...worlds.camera import DISC
from ..mavlink.last_messages import PART
from ..options import EnvOptionError, unknown
from ..past import Film
from ..pictures import PICTURES, Picture
from ..robots.true_state import STATE, true_states

Floats = npt.NDArray[np.float64]
Narrow = npt.NDArray[np.float32]
STATE_NAME, SCAN_NAME = "state", "scan"
NAMES = (STATE_NAME, SCAN_NAME, *PICTURES)
SCAN_MESSAGE = "DEBUG_FLOAT_ARRAY"


class Onlooker:
    """One vehicle of a swarm, as pictures know robots (``sitl.envs.robots.robot.Robot``)."""

    count = 1

    def __init__(self, swarm: Swarm, number: int) -> None:
        vehicle, world = swarm.vehicles[number], swarm.scenarios[number].world
        assert isinstance(world, World)
        self.name, self.world = vehicle.airframe.name, world
        self._bodies = [_body(other) for other in swarm.vehicles]
        self._airframes = [other.airframe for other in swarm.vehicles]
        self._number, self._state = number, np.zeros((1, STATE))
        forward, right, down = vehicle.airframe.value("lidar_at")
        if vehicle.airframe.value("lidar_samples") == 0:
            forward, right, down = 0.0, 0.0, -float(vehicle.airframe.value("contact_top"))
        self.camera_mount = forward, -right, -down, 0.0

    def true_state(self) -> Floats:
        """See ``sitl.envs.senses.SensingRobot``."""
        true_states(self._bodies[self._number], 0.0, self._state)
        return self._state

    def others(self) -> Floats:
        """Outlines of the other vehicles, upright discs, shape (1, n, ``DISC``)."""
        found = []
        for k, (body, airframe) in enumerate(zip(self._bodies, self._airframes, strict=True)):
            if k == self._number or airframe.value("contact_radius") == 0.0:
                continue
            north, east, down = body["pos"][0].tolist()
            w, x, y, z = body["q"][0].tolist()
            ahead, aside, below = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
            for along in airframe.value("contact_along")[: int(airframe.value("contact_discs"))]:
                middle = down + along * below
                top, bottom = middle - airframe.value("contact_top"), middle + airframe.value("contact_bottom")
                found.append(
                    (north + along * ahead, east + along * aside, airframe.value("contact_radius"), top, bottom)
                )
        return np.array(found, np.float64).reshape(1, -1, DISC)


def _body(vehicle: Simulation) -> Any:
    return vehicle.fleet[vehicle.index : vehicle.index + 1]["physics"]["body"]


class Sight:
    """The option ``observation`` of a swarm.

    Args:
        option: "state" (the box of ``SwarmEnv``), "scan", names of pictures (``sitl.envs.pictures.PICTURES``); names
            joined by "+", or a dict of names and pictures, give a dict.
        swarm: whose vehicles see.
        seconds: duration of a step [s].
        state: space of "state".

    Raises:
        EnvOptionError: no such name; "scan", and a vehicle has no lidar; a setting of a picture that cannot be.
    """

    def __init__(self, option: Any, swarm: Swarm, seconds: float, state: gym.spaces.Box) -> None:
        names = option.split("+") if isinstance(option, str) else option
        self._is_alone = isinstance(option, str) and len(names) == 1
        wanted = dict(names) if isinstance(names, Mapping) else {name: name for name in names}
        if not wanted:
            raise EnvOptionError(f"observation {option!r} has no entries")
        for name, piece in wanted.items():
            if not isinstance(piece, Picture) and (not isinstance(piece, str) or piece not in NAMES):
                raise unknown("observation", piece if isinstance(piece, str) else name, NAMES)
        self._wanted, self._state, self._swarm = wanted, state, swarm
        count = len(swarm)
        self.readings = [int(vehicle.airframe.value("lidar_samples")) for vehicle in swarm.vehicles]
        """Of each vehicle's lidar; 0: it has none."""
        self.reads_scan = SCAN_NAME in wanted.values()
        """Whether scans are to be asked for."""
        if self.reads_scan and not all(self.readings):
            without = swarm.vehicles[self.readings.index(0)].airframe.name
            raise EnvOptionError(f"observation 'scan': {without} has no lidar")
        self._reach = [float(vehicle.airframe.value("lidar_max")) for vehicle in swarm.vehicles]
        self.scans: list[Narrow] = [np.full(-(-n // PART) * PART, np.inf, np.float32) for n in self.readings]
        """Last readings of each vehicle's lidar and beyond [m], from right to left."""
        self._onlookers = [Onlooker(swarm, k) for k in range(count)]
        self._pictures: list[dict[str, Any]] = [
            {name: _picture(piece) for name, piece in wanted.items() if piece not in (STATE_NAME, SCAN_NAME)}
            for _ in range(count)
        ]
        for seat, pictures in zip(self._onlookers, self._pictures, strict=True):
            for picture in pictures.values():
                picture.prepare(_Seat(seat, seconds))

    def space(self, number: int) -> gym.Space[Any]:
        """Of one vehicle's observation."""
        spaces: dict[str, gym.Space[Any]] = {}
        for name, piece in self._wanted.items():
            if piece == STATE_NAME:
                spaces[name] = gym.spaces.Box(self._state.low, self._state.high)
            elif piece == SCAN_NAME:
                spaces[name] = gym.spaces.Box(0.0, self._reach[number], (self.readings[number],), np.float32)
            else:
                spaces[name] = self._pictures[number][name].space(self._onlookers[number])
        return next(iter(spaces.values())) if self._is_alone else gym.spaces.Dict(spaces)

    def hear(self, number: int, part: Any) -> None:
        """A part of a scan: DEBUG_FLOAT_ARRAY."""
        first, scan = PART * part.array_id, self.scans[number]
        if first < len(scan):
            scan[first : first + PART] = part.data

    def start(self, seed: int) -> None:
        """An episode begins."""
        for k, pictures in enumerate(self._pictures):
            for j, picture in enumerate(pictures.values()):
                picture.start(0, seed + ((k * len(pictures) + j) << 32))
                picture.begin(None)

    def note(self) -> None:
        """All have gone on by a step."""
        for pictures in self._pictures:
            for picture in pictures.values():
                picture.note(None)

    def observe(self, number: int, state: Narrow) -> Any:
        """What one vehicle observes.

        Args:
            number: of the vehicle.
            state: its part "state".
        """
        found: dict[str, Any] = {}
        for name, piece in self._wanted.items():
            if piece == STATE_NAME:
                found[name] = state
            elif piece == SCAN_NAME:
                found[name] = np.minimum(self.scans[number][: self.readings[number]], np.float32(self._reach[number]))
            else:
                found[name] = self._pictures[number][name].observe(self._onlookers[number])[0]
        return next(iter(found.values())) if self._is_alone else found

    def memory(self) -> tuple[list[Narrow], list[list[Film]]]:
        """For copies."""
        films = [[picture.memory(0) for picture in pictures.values()] for pictures in self._pictures]
        return [scan.copy() for scan in self.scans], films

    def recall(self, memory: tuple[list[Narrow], list[list[Film]]]) -> None:
        """Go on as from a ``memory``."""
        self.scans = [scan.copy() for scan in memory[0]]
        for pictures, films in zip(self._pictures, memory[1], strict=True):
            for picture, film in zip(pictures.values(), films, strict=True):
                picture.recall(0, film)


class _Seat:
    """What a picture is prepared with."""

    def __init__(self, robot: Onlooker, seconds: float) -> None:
        self.robot, self.seconds = robot, seconds


def _picture(piece: Any) -> Any:
    return PICTURES[piece]() if isinstance(piece, str) else deepcopy(piece)
