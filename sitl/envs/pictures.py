# SPDX-License-Identifier: BSD-3-Clause
"""Pictures as observations: depth, and a camera, cast at the world's solids from where the robot really is.

They are no MAVLink messages: on a real vehicle such a camera is wired to a companion computer. Pictures are taken at
the ends of steps, so rate and latency are whole numbers of steps.
"""

from __future__ import annotations

import math
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core.algebra import multiply, quat_from_euler, rotate
from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.kernels import law
from sitl.core.sums import products
from sitl.core.vectors import Euler, Vec3
from sitl.worlds.camera import DISC, Photographer
from sitl.worlds.camera import Camera as Optics
from sitl.worlds.shapes import to_heading, to_ned

from ..core.elementary import sincos, tan
from .noise import standard_normal
from .options import EnvOptionError
from .past import Film, Past, Remembering
from .robots.robot import Floats, Robot, world_of
from .worlds import PerWorld

MOST_PIXELS = 1_000_000
POSE = 7
"""Numbers of a pose: NED [m], attitude (w, x, y, z)."""


@law
def write_poses(states: Table, ahead: float, mount: Line, out: Table) -> None:
    """Write where cameras are.

    Args:
        states: of the robots (``senses.SensingRobot``), shape (m, 12).
        ahead: how far the robot's base lies ahead of the body's origin [m].
        mount: position on the body, forward, right, down [m], and how far the camera looks down [rad].
        out: position NED [m], attitude (w, x, y, z), shape (m, 7).
    """
    tilt = quat_from_euler(Euler(0.0, -mount[3], 0.0))
    for i in range(out.shape[0]):
        heading = to_heading(states[i, 3])
        north, east, down = to_ned(states[i, 0], states[i, 1], states[i, 2])
        q = quat_from_euler(Euler(states[i, 8], states[i, 9], heading))
        at = rotate(q, Vec3(mount[0], mount[1], mount[2]))
        sine, cosine = sincos(heading)
        out[i, 0] = north - ahead * cosine + at.x
        out[i, 1] = east - ahead * sine + at.y
        out[i, 2] = down + at.z
        turned = multiply(q, tilt)
        out[i, 3], out[i, 4], out[i, 5], out[i, 6] = turned.w, turned.x, turned.y, turned.z


_poses = Kernel(write_poses)


class Picture:
    """Base of pictures: where they are taken, and when.

    Args:
        width, height: in pixels, which are square.
        field_of_view: from the left to the right edge [deg].
        reach: how far it sees [m]; depths beyond read as it.
        at: position on the robot: forward, left, up of its body's origin [m]; None: that of its lidar.
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
        self._optics = Optics(width, height, tan(0.5 * math.radians(field_of_view)), float(reach))
        self._at, self._pitch, self._rate, self._latency, self._noise = at, math.radians(pitch), rate, latency, noise
        self.remembers: tuple[Remembering, ...] = (self,)

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
        self._robot, self._others = robot, getattr(robot, "others", None)
        discs = 0 if self._others is None else self._others().shape[1]
        self._past = Past(self.name, robot.count, POSE + DISC * discs, seconds, self._rate, self._latency)
        """Where the camera was, and what moved about, at the ends of the last steps."""
        self._photographers = PerWorld(Photographer(robot.world, self._optics).in_world)
        self._poses = np.zeros((robot.count, POSE))

    # ------------------------------------------------------------------ episodes

    def start(self, index: int, seed: int) -> None:
        """See ``Remembering``."""
        self._past.start(index, seed)

    def begin(self, which: npt.NDArray[np.bool_] | None) -> None:
        """See ``Remembering``."""
        self._past.begin(self._look(), which)

    def note(self, which: npt.NDArray[np.bool_] | None) -> None:
        """See ``Remembering``."""
        self._past.note(self._look(), which)

    def _look(self) -> Floats:
        """What the pictures of now need, a row a robot."""
        _poses(self._robot.true_state(), self._ahead, self._mount, self._poses)
        if self._others is None:
            return self._poses
        return np.concatenate((self._poses, self._others().reshape(len(self._poses), -1)), axis=1)

    def memory(self, index: int) -> Film:
        """See ``Remembering``."""
        return self._past.memory(index)

    def recall(self, index: int, film: Film) -> None:
        """See ``Remembering``."""
        self._past.recall(index, film)

    # ------------------------------------------------------------------ pictures

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        raise NotImplementedError

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        seen = self._past.seen()
        poses, discs = np.ascontiguousarray(seen[:, :POSE]), seen[:, POSE:].reshape(len(seen), -1, DISC)
        out = self._take_in_worlds(poses, discs)
        if self._noise > 0.0:
            for i, rng in enumerate(self._past.generators()):
                out[i] = self._spoilt(out[i] + self._noise * standard_normal(rng, out[i].shape, np.float32))
        return out

    def _take_in_worlds(self, poses: Floats, discs: Floats) -> npt.NDArray[Any]:
        """Pictures of all robots, each in its world."""
        worlds = [world_of(self._robot, index) for index in range(len(poses))]
        if all(world is worlds[0] for world in worlds):
            return self._take(self._photographers(worlds[0]), poses, discs)
        each = ((self._photographers(world), slice(k, k + 1)) for k, world in enumerate(worlds))
        return np.concatenate([self._take(one, poses[row], discs[row]) for one, row in each])

    def _take(self, photographer: Photographer, poses: Floats, discs: Floats) -> npt.NDArray[Any]:
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

    def _take(self, photographer: Photographer, poses: Floats, discs: Floats) -> npt.NDArray[Any]:
        return photographer.depths(poses, discs)

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

    def _take(self, photographer: Photographer, poses: Floats, discs: Floats) -> npt.NDArray[Any]:
        colours = photographer.colours(poses, discs)
        if not self._grey:
            return colours
        shares = np.array([77, 150, 29], np.uint32)  # of 256: luma of ITU-R BT.601
        luma: npt.NDArray[Any] = (products(colours, shares) >> 8).astype(np.uint8)[..., None]
        return luma

    def _spoilt(self, noisy: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


PICTURES: dict[str, Any] = {"depth": Depth, "camera": Camera, "grey": lambda: Camera(grey=True)}
"""By name."""
