# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: where their cameras are mounted, what limits their numbers and settings have, what grey is."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.pictures import MOST_PIXELS, PICTURES, Camera, Depth
from sitl.worlds import load

MAZE = load("maze")


def robots(count: int = 1, **more: Any) -> Any:
    """That stand at the world's origin and look north, with a lidar 0.1 m ahead, 0.2 m to the left, 0.3 m up."""
    return SimpleNamespace(
        name="robot", count=count, world=MAZE, camera_mount=(0.1, 0.2, 0.3, 0.05),
        true_state=lambda: np.zeros((count, 12)), **more,
    )  # fmt: skip


def prepared(picture: Any, robot: Any = None) -> Any:
    picture.prepare(SimpleNamespace(robot=robot or robots(), seconds=0.5))
    for index in range(picture._robot.count):
        picture.start(index, 7 + index)
    picture.begin(None)
    return picture


# ---------------------------------------------------------------- noise


def test_noisy_colours_stay_bytes_and_do_not_wrap_round() -> None:
    """The nearest whole number within 0 .. 255: beyond white is white, not black."""
    noisy = np.array([-300.0, -0.6, 0.4, 0.6, 127.4, 254.6, 255.4, 255.6, 256.0, 300.0, 600.0], np.float32)
    found = Camera()._spoilt(noisy)
    assert found.dtype == np.uint8
    assert found.tolist() == [0, 0, 0, 1, 127, 255, 255, 255, 255, 255, 255]


def test_noisy_depths_stay_within_reach() -> None:
    found = Depth(reach=6.0)._spoilt(np.array([-0.1, 0.0, 3.25, 6.0, 6.1, 99.0], np.float32))
    assert found.dtype == np.float32
    assert found.tolist() == [0.0, 0.0, 3.25, 6.0, 6.0, 6.0]


@pytest.mark.parametrize("make", [lambda: Depth(8, 6, reach=5.0, noise=900.0), lambda: Camera(8, 6, noise=900.0)])
def test_the_noisiest_picture_is_one_of_its_space(make: Any) -> None:
    """Such noise takes nearly all numbers to a limit, half of them to each."""
    picture = prepared(make(), robots(2))
    seen, space = picture.observe(picture._robot), picture.space(picture._robot)
    assert all(space.contains(each) for each in seen) and not np.array_equal(seen[0], seen[1])
    for limit in (space.low.min(), space.high.max()):
        assert 0.25 < np.mean(seen == limit) < 0.75


# ---------------------------------------------------------------- mounts and optics


@pytest.mark.parametrize(
    ("at", "pitch", "position", "down"),
    [
        (None, 0.0, (0.1 - 0.05, -0.2, -0.3), 0.0),  # that of the lidar
        ((0.4, 0.5, 0.6), 0.0, (0.4 - 0.05, -0.5, -0.6), 0.0),  # forward, left, up is north, west, up
        ((0.0, 0.0, 0.0), 90.0, (-0.05, 0.0, 0.0), 1.0),
        ((0.0, 0.0, 0.0), -30.0, (-0.05, 0.0, 0.0), -0.5),
    ],
)
def test_a_camera_is_where_it_was_mounted_and_looks_down(at: Any, pitch: float, position: Any, down: float) -> None:
    """The robot's base is at the origin, 0.05 m ahead of its body's; poses are NED."""
    picture = prepared(Depth(8, 6, at=at, pitch=pitch))
    north, east, below, w, x, y, z = picture._past.seen()[0]
    assert (north, east, below) == pytest.approx(position)
    assert 2.0 * (x * z - w * y) == pytest.approx(down), "down component of the direction in which it looks"


@pytest.mark.parametrize("angle", [60.0, 90.0, 120.0])
def test_the_field_of_view_is_from_edge_to_edge(angle: float) -> None:
    optics = Depth(8, 6, angle)._optics
    assert optics.slope == pytest.approx(math.tan(math.radians(angle / 2.0)))
    assert (optics.width, optics.height, optics.reach) == (8, 6, 20.0)


# ---------------------------------------------------------------- spaces, and grey


@pytest.mark.parametrize(
    ("name", "shape", "high", "dtype"),
    [("depth", (48, 64), 20.0, "float32"), ("camera", (48, 64, 3), 255, "uint8"), ("grey", (48, 64, 1), 255, "uint8")],
)
def test_pictures_by_name(name: str, shape: Any, high: float, dtype: str) -> None:
    space = PICTURES[name]().space(robots())
    assert (space.shape, space.low.min(), space.high.max(), space.dtype) == (shape, 0, high, dtype)
    assert space.low.max() == 0 and space.high.min() == high


def test_grey_is_the_luma_of_the_colour() -> None:
    """ITU-R BT.601: 0.299 red, 0.587 green, 0.114 blue, each to the nearest 256th; rounded down."""
    colours = np.array([[(0, 0, 0), (255, 255, 255), (255, 0, 0), (0, 255, 0), (0, 0, 255), (10, 200, 90)]], np.uint8)
    photographer: Any = SimpleNamespace(colours=lambda poses, discs: colours[None])
    found = Camera(6, 1, grey=True)._take(photographer, np.zeros((1, 7)), np.zeros((1, 0, 3)))
    assert found.shape == (1, 1, 6, 1) and found.dtype == np.uint8
    shares = [round(256 * share) for share in (0.299, 0.587, 0.114)]
    assert found[0, 0, :, 0].tolist() == [int(pixel @ shares) // 256 for pixel in colours[0].astype(int)]
    assert found[0, 0, :2, 0].tolist() == [0, 255], "black is black, white is white"


# ---------------------------------------------------------------- settings


@pytest.mark.parametrize(
    ("name", "low", "high", "unit"),
    [
        ("field_of_view", 1.0, 170.0, "deg"), ("reach", 0.1, 1e4, "m"), ("pitch", -90.0, 90.0, "deg"),
        ("rate", 1e-3, 1e4, "Hz"), ("latency", 0.0, 60.0, "s"), ("noise", 0.0, 1e3, "of a number"),
    ],
)  # fmt: skip
def test_settings_have_limits(name: str, low: float, high: float, unit: str) -> None:
    for allowed in (low, high):
        Depth(**{name: allowed})
    for refused in (low - 1e-6, high + 1.0, math.nan, math.inf, "1"):
        with pytest.raises(EnvOptionError, match=rf"^observation 'depth': {name} = .*; it must be .* \.\. .* {unit}$"):
            Depth(**{name: refused})  # type: ignore[arg-type]


@pytest.mark.parametrize(("width", "height"), [(0, 1), (1, 0), (-1, 5), (1.5, 2), (MOST_PIXELS + 1, 1), (1001, 1000)])
def test_sides_have_limits(width: Any, height: Any) -> None:
    with pytest.raises(EnvOptionError, match="whole numbers from 1, 1,000,000 pixels at most"):
        Depth(width, height)


def test_the_smallest_and_the_largest_picture() -> None:
    for width, height in ((1, 1), (1000, 1000), (MOST_PIXELS, 1)):
        assert Depth(width, height).space(robots()).shape == (height, width)


@pytest.mark.parametrize("at", [(1.0, 2.0), (1.0, 2.0, 3.0, 4.0), (0.0, math.nan, 0.0), (0.0, 0.0, math.inf)])
def test_a_mount_is_three_finite_numbers(at: Any) -> None:
    with pytest.raises(EnvOptionError, match="it must be forward, left, up: three finite numbers"):
        Depth(at=at)
