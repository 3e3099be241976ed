# SPDX-License-Identifier: BSD-3-Clause
"""Pictures as observations: depth, and a camera, cast at the world's solids from where the robot really is.

They are no MAVLink messages: on a real vehicle such a camera is wired to a companion computer. Pictures are taken at
the ends of steps, so rate and latency are whole numbers of steps.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core.algebra import multiply, quat_from_euler, rotate
from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.kernels import law
from sitl.core.vectors import Euler, Vec3
from sitl.worlds.camera import Camera as Optics
from sitl.worlds.camera import Photographer
from sitl.worlds.shapes import to_heading, to_ned

from .options import EnvOptionError
from .robots.robot import Floats, Robot

MOST_PIXELS = 1_000_000


class Film(NamedTuple):
    """What one robot's pictures need to go on, for a snapshot."""

    steps: int
    """Since the episode began."""
    seed: int
    places: Floats
    """Of the camera at the last steps."""


@law
def write_places(states: Table, ahead: float, mount: Line, out: Table) -> None:
    """Write where cameras are.

    Args:
        states: of the robots (``senses.SensingRobot``), shape (m, 12).
        ahead: how far the robot's base lies ahead of the body's origin [m].
        mount: place on the body, forward, right, down [m], and how far the camera looks down [rad].
        out: place NED [m], attitude (w, x, y, z), shape (m, 7).
    """
    tilt = quat_from_euler(Euler(0.0, -mount[3], 0.0))
    for i in range(out.shape[0]):
        heading = to_heading(states[i, 3])
        north, east, down = to_ned(states[i, 0], states[i, 1], states[i, 2])
        q = quat_from_euler(Euler(states[i, 8], states[i, 9], heading))
        at = rotate(q, Vec3(mount[0], mount[1], mount[2]))
        out[i, 0] = north - ahead * math.cos(heading) + at.x
        out[i, 1] = east - ahead * math.sin(heading) + at.y
        out[i, 2] = down + at.z
        turned = multiply(q, tilt)
        out[i, 3], out[i, 4], out[i, 5], out[i, 6] = turned.w, turned.x, turned.y, turned.z


_places = Kernel(write_places)


class Picture:
    """Base of pictures: where they are taken, and when.

    Args:
        width, height: in pixels, which are square.
        field_of_view: from the left to the right edge [deg].
        reach: how far it sees [m]; depths beyond read as it.
        at: place on the robot: forward, left, up of its body's origin [m]; None: that of its lidar.
        pitch: how far it looks down [deg].
        rate: pictures a second [Hz], whole steps apart; None: one each step.
        latency: age of a picture when it is seen [s], whole steps.
        noise: standard deviation of each number, in its unit.

    Raises:
        EnvOptionError: a number that cannot be.
    """

    name = ""
    reads_scan = False

    def __init__(
        self, width: int = 64, height: int = 48, field_of_view: float = 90.0, reach: float = 20.0, *,
        at: tuple[float, float, float] | None = None, pitch: float = 0.0, rate: float | None = None,
        latency: float = 0.0, noise: float = 0.0,
    ) -> None:  # fmt: skip
        sides = all(isinstance(side, int) and side >= 1 for side in (width, height))
        if not sides or width * height > MOST_PIXELS:
            raise self._refused(f"width = {width!r}, height = {height!r}: whole numbers from 1, {MOST_PIXELS:,} pixels "
                                "at most")  # fmt: skip
        for what, value, low, high, unit in (
            ("field_of_view", field_of_view, 1.0, 170.0, "deg"), ("reach", reach, 0.1, 1e4, "m"),
            ("pitch", pitch, -90.0, 90.0, "deg"), ("rate", 1.0 if rate is None else rate, 1e-3, 1e4, "Hz"),
            ("latency", latency, 0.0, 60.0, "s"), ("noise", noise, 0.0, 1e3, "of a number"),
        ):  # fmt: skip
            if not (isinstance(value, int | float | np.number) and low <= value <= high):
                raise self._refused(f"{what} = {value!r}; it must be {low:g} .. {high:g} {unit}")
        if at is not None and (len(at) != 3 or not np.all(np.isfinite(at))):
            raise self._refused(f"at = {at!r}; it must be forward, left, up: three finite numbers [m]")
        self._optics = Optics(width, height, math.tan(0.5 * math.radians(field_of_view)), float(reach))
        self._at, self._pitch, self._rate, self._latency, self._noise = at, math.radians(pitch), rate, latency, noise
        self.pictures: tuple[Picture, ...] = (self,)

    def _refused(self, why: str) -> EnvOptionError:
        return EnvOptionError(f"observation {self.name!r}: {why}")

    def prepare(self, session: Any) -> None:
        """Called once, when the robot is there.

        Raises:
            EnvOptionError: nobody knows where the robot really is; rate or latency are not whole steps.
        """
        robot, seconds = session.robot, session.seconds
        mount = getattr(robot, "camera_mount", None)
        if mount is None:
            raise self._refused(
                f"robot {robot.name!r} shows no world to a camera: only robots and vehicles in this process do"
            )
        forward, left, up, self._ahead = mount
        if self._at is not None:
            forward, left, up = self._at
        self._mount = np.array([forward, -left, -up, self._pitch])
        self._every = self._steps("1 / rate", 1.0 / self._rate if self._rate else seconds, seconds)
        self._age = self._steps("latency", self._latency, seconds) if self._latency else 0
        self._robot = robot
        self._photographer = Photographer(robot.world, self._optics)
        self._now = np.zeros((robot.count, 7))
        self._past = np.zeros((robot.count, self._every + self._age, 7))
        """Where the camera was at the end of a step, by its number."""
        self._count, self._seeds = np.zeros((2, robot.count), np.int64)

    def _steps(self, what: str, wanted: float, seconds: float) -> int:
        steps = round(wanted / seconds)
        if steps < 1 or abs(steps * seconds - wanted) > 1e-6:
            raise self._refused(f"{what} = {wanted:g} s is not a whole number of steps of {seconds:g} s")
        return steps

    # ------------------------------------------------------------------ episodes

    def start(self, index: int, seed: int) -> None:
        """An episode of one robot begins."""
        self._look()
        self._count[index], self._seeds[index] = 0, seed
        self._past[index] = self._now[index]

    def note(self, rows: npt.NDArray[np.bool_] | None) -> None:
        """These robots (None: all) have gone on by a step."""
        self._look()
        which = np.arange(len(self._count)) if rows is None else np.flatnonzero(rows)
        self._count[which] += 1
        self._past[which, self._count[which] % self._past.shape[1]] = self._now[which]

    def _look(self) -> None:
        _places(self._robot.true_state(), self._ahead, self._mount, self._now)

    def memory(self, index: int) -> Film:
        """For a snapshot of one robot."""
        return Film(int(self._count[index]), int(self._seeds[index]), self._past[index].copy())

    def recall(self, index: int, film: Film) -> None:
        """Go on as from a ``memory``.

        Raises:
            EnvOptionError: it is of pictures with another rate or latency.
        """
        if np.shape(film.places) != self._past[index].shape:
            raise EnvOptionError(f"snapshot cannot be restored: {self.name!r} had another rate or latency")
        self._count[index], self._seeds[index], self._past[index] = film

    # ------------------------------------------------------------------ pictures

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        raise NotImplementedError

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        taken = np.maximum((self._count - self._age) // self._every * self._every, 0)
        rows = np.arange(len(taken))
        out = self._take(np.ascontiguousarray(self._past[rows, taken % self._past.shape[1]]))
        if self._noise > 0.0:
            for i in rows.tolist():
                rng = np.random.default_rng((int(self._seeds[i]), int(taken[i])))
                out[i] = self._spoilt(out[i] + self._noise * rng.standard_normal(out[i].shape, np.float32))
        return out

    def _take(self, places: Floats) -> npt.NDArray[Any]:
        raise NotImplementedError

    def _spoilt(self, noisy: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        """Noisy numbers within the limits of a picture."""
        raise NotImplementedError


class Depth(Picture):
    """Depth along the camera's axis [m], float32, shape (height, width), 0 .. ``reach``, as depth cameras give it."""

    name = "depth"

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        return gym.spaces.Box(0.0, self._optics.reach, (self._optics.height, self._optics.width), np.float32)

    def _take(self, places: Floats) -> npt.NDArray[Any]:
        return self._photographer.depths(places)

    def _spoilt(self, noisy: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        return np.clip(noisy, 0.0, self._optics.reach)


class Camera(Picture):
    """Red, green, blue, uint8, shape (height, width, 3): colours of the world file in the sun's light, a chequered
    floor, a sky. ``grey``: one channel, shape (height, width, 1). Arguments as of ``Picture``."""

    name = "camera"

    def __init__(self, *args: Any, grey: bool = False, **others: Any) -> None:
        super().__init__(*args, **others)
        self._grey = bool(grey)

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        channels = 1 if self._grey else 3
        return gym.spaces.Box(0, 255, (self._optics.height, self._optics.width, channels), np.uint8)

    def _take(self, places: Floats) -> npt.NDArray[Any]:
        colours = self._photographer.colours(places)
        if not self._grey:
            return colours
        shares = np.array([77, 150, 29], np.uint32)  # of 256: luma of ITU-R BT.601
        luma: npt.NDArray[Any] = ((colours @ shares) >> 8).astype(np.uint8)[..., None]
        return luma

    def _spoilt(self, noisy: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


PICTURES: dict[str, Any] = {"depth": Depth, "camera": Camera, "grey": lambda: Camera(grey=True)}
"""By name."""
