# SPDX-License-Identifier: BSD-3-Clause
"""Pictures from above of a robot that stands where the test says: what is drawn where, in which colour."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from gymnasium.error import DependencyNotInstalled

from sitl.envs.rendering import Renderer, tile
from sitl.envs.robots.robot import Volume
from sitl.envs.tasks import ReachGoal
from sitl.worlds import World
from sitl.worlds.shapes import Box, Marking, Start

pytest.importorskip("pygame")
WALL, LOW_WALL, PAPER = (62, 68, 76), (190, 194, 198), (250, 250, 247)
BODY, CRASHED, NOSE, TRAIL, GOAL = (40, 90, 160), (200, 50, 40), (255, 255, 255), (70, 130, 180), (60, 150, 80)
EMPTY: Any = SimpleNamespace()


def world(*solids: Any, markings: tuple[Marking, ...] = (), size: float = 10.0) -> World:
    """From 0 to ``size`` along x, and half of it along y, with two posts at its corners; plans are cut at 0.5 m."""
    corners = (Box((0.05, 0.05, 0.5), (0.1, 0.1, 1.0)), Box((size - 0.05, size / 2 - 0.05, 0.5), (0.1, 0.1, 1.0)))
    return World("plain", (*corners, *solids), (Start("middle", (1.0, 1.0, 0.0), 0.0),), markings=markings)


def robot(x: float, y: float, yaw: float = 0.0, **more: Any) -> Any:
    """One robot with a lidar of one ray ahead, which sees nothing."""
    return SimpleNamespace(
        **{
            "name": "toy", "world": world(), "pose": np.array([[x, y, 0.0, yaw]]), "angles": np.array([0.0]),
            "scan": np.array([[99.0]]), "range_max": 5.0, "volume": Volume(0.5, 0.0, 0.5),
            "collided": np.array([False]), **more,
        }
    )  # fmt: skip


def picture(found: Any, task: Any = EMPTY, index: int = 0) -> Any:
    drawn = Renderer(found, task, index)
    drawn.start()
    return drawn.picture()


def pixel(image: Any, x: float, y: float) -> tuple[int, ...]:
    """At a place of the world [m]: the world is 11 m by 6 m with its border of half a metre."""
    scale = 640 / 11.0
    return tuple(int(c) for c in image[int(image.shape[0] - (y + 0.5) * scale), int((x + 0.5) * scale)])


def test_the_longer_side_has_640_pixels_and_x_goes_to_the_right() -> None:
    image = picture(robot(2.0, 1.0))
    assert image.shape == (350, 640, 3) and image.dtype == np.uint8
    assert pixel(image, 0.05, 0.05) == WALL == pixel(image, 9.95, 4.95)
    assert pixel(image, 9.95, 0.05) == PAPER == pixel(image, 0.05, 4.95)
    assert pixel(image, 2.0, 1.3) == BODY == pixel(image, 2.0, 0.7) and pixel(image, 2.0, 1.6) == PAPER


@pytest.mark.parametrize(
    ("yaw", "at"), [(0.0, (2.3, 2.0)), (math.pi / 2, (2.0, 2.3)), (math.pi, (1.7, 2.0)), (-math.pi / 2, (2.0, 1.7))]
)
def test_the_nose_is_where_it_looks(yaw: float, at: tuple[float, float]) -> None:
    image = picture(robot(2.0, 2.0, yaw))
    assert pixel(image, *at) == NOSE
    assert pixel(image, 4.0 - at[0], 4.0 - at[1]) == BODY, "not behind"


def test_who_has_collided_is_red() -> None:
    assert pixel(picture(robot(2.0, 1.0, collided=np.array([True]))), 2.0, 1.3) == CRASHED


def test_a_tiny_robot_can_be_seen() -> None:
    image = picture(robot(2.0, 1.0, volume=Volume(0.001, 0.0, 0.1)))
    assert (image == BODY).all(axis=2).sum() > 20


@pytest.mark.parametrize(("reading", "drawn"), [(3.0, True), (5.0, True), (5.01, False)])
def test_rays_end_where_they_meet_something(reading: float, drawn: bool) -> None:
    found = robot(2.0, 2.0, math.pi / 2, angles=np.array([-math.pi / 2]), scan=np.array([[reading]]))
    image = picture(found).astype(int)
    row = int(image.shape[0] - 2.5 * 640 / 11.0)
    line = np.abs(image[row - 3 : row + 4] - np.array(PAPER)).sum(axis=2).max(axis=0) > 30
    columns = np.flatnonzero(line) / (640 / 11.0) - 0.5
    end = 2.0 + reading if drawn else 2.5
    assert columns.max() == pytest.approx(end, abs=0.1), "to the right of who looks up"


@pytest.mark.parametrize(
    ("low", "high", "colour"),
    [(0.0, 1.0, WALL), (0.0, 0.4, LOW_WALL), (0.6, 1.0, LOW_WALL), (0.5, 1.0, WALL), (0.0, 0.5, WALL)],
)
def test_what_the_lidar_does_not_meet_is_pale(low: float, high: float, colour: Any) -> None:
    box = Box((6.0, 2.0, (low + high) / 2), (1.0, 1.0, high - low))
    assert pixel(picture(robot(2.0, 2.0, world=world(box))), 6.0, 2.0) == colour


def test_high_walls_are_drawn_over_low_ones() -> None:
    high, low = Box((6.0, 2.0, 0.5), (1.0, 1.0, 1.0)), Box((6.0, 2.0, 0.1), (2.0, 2.0, 0.2))
    for solids in ((high, low), (low, high)):
        image = picture(robot(2.0, 2.0, world=world(*solids)))
        assert (pixel(image, 6.0, 2.0), pixel(image, 6.8, 2.0)) == (WALL, LOW_WALL)


def test_markings_are_pale_and_below_walls() -> None:
    image = picture(robot(2.0, 2.0, world=world(markings=(Marking((6.0, 2.0), 1.0, colour="red"),))))
    red, green, blue = pixel(image, 6.0, 2.0)
    assert red > green + 40 and red > blue + 40 and green > 100


def test_the_trail_goes_through_all_places_since_the_start() -> None:
    found = robot(1.0, 1.0)
    drawn = Renderer(found, EMPTY)
    drawn.start()
    for x in (2.0, 3.0, 4.0, 5.0, 6.0):
        found.pose[0, 0] = x
        drawn.note()
        last = drawn.picture()
    assert len(drawn.trail) == 6
    assert all(TRAIL in (pixel(last, x, 1.0), pixel(last, x, 1.01)) for x in (1.5, 3.5, 5.0))
    assert pixel(last, 1.0, 1.2) == PAPER, "it is not there any more"
    drawn.start()
    assert len(drawn.trail) == 1
    assert not (drawn.picture() == TRAIL).all(axis=2).any()


def test_a_goal_is_a_ring_of_its_radius() -> None:
    task = ReachGoal((6.0, 2.0), radius=1.0)
    task.goals = np.array([[6.0, 2.0]])
    image = picture(robot(2.0, 2.0), task)
    ring = np.flatnonzero((image == GOAL).all(axis=2).any(axis=0)) / (640 / 11.0) - 0.5
    assert (ring.min(), ring.max()) == (pytest.approx(5.0, abs=0.05), pytest.approx(7.0, abs=0.05))
    assert pixel(image, 6.0, 2.0) == PAPER


def test_another_world_keeps_the_size_of_pictures() -> None:
    found = robot(2.0, 2.0)
    drawn = Renderer(found, EMPTY)
    drawn.start()
    first = drawn.picture()
    found.world = world(size=20.0)
    drawn.start()
    second = drawn.picture()
    assert second.shape == first.shape and not np.array_equal(first, second)
    found.worlds = [found.world, world()]
    found.pose = np.array([[2.0, 2.0, 0.0, 0.0]] * 2)
    found.collided, found.scan = np.array([False] * 2), np.array([[99.0]] * 2)
    assert np.array_equal(picture(found, index=1), first), "each robot in its own"


def test_a_renderer_of_the_physics_comes_first() -> None:
    asked = []

    def photograph(index: int, width: int, height: int) -> Any:
        asked.append((index, width, height))
        return np.full((height, width, 3), 7.0)

    image = picture(robot(2.0, 2.0, photograph=photograph))
    assert image.dtype == np.uint8 and image.shape == (480, 640, 3) and (image == 7).all()
    assert asked == [(0, 640, 480)]
    assert picture(robot(2.0, 2.0, photograph=lambda *a: None)).shape == (350, 640, 3)


@pytest.mark.parametrize(("count", "shape"), [(1, (1, 1)), (2, (1, 2)), (3, (2, 2)), (4, (2, 2)), (5, (2, 3)),
                                              (7, (3, 3)), (10, (3, 4))])  # fmt: skip
def test_pictures_of_many_are_in_a_grid_row_by_row(count: int, shape: tuple[int, int]) -> None:
    pictures = [np.full((2, 3, 3), k + 1, np.uint8) for k in range(count)]
    out = tile(pictures)
    assert out.shape == (2 * shape[0], 3 * shape[1], 3)
    numbers = out[::2, ::3, 0].reshape(-1).tolist()
    assert numbers == [*range(1, count + 1), *[0] * (shape[0] * shape[1] - count)]


def test_without_a_screen_a_window_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    drawn = Renderer(robot(2.0, 2.0), EMPTY)
    drawn.start()
    with pytest.raises(DependencyNotInstalled, match='render_mode "window" finds no screen'):
        drawn.show()
    drawn.close()


def test_a_window_shows_the_picture_until_it_is_closed_and_opens_again(monkeypatch: pytest.MonkeyPatch) -> None:
    import pygame

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    drawn = Renderer(robot(2.0, 2.0), EMPTY)
    drawn.start()
    drawn.close()
    assert not pygame.display.get_init(), "nothing was open"
    for _ in range(2):
        drawn.show()
        surface = pygame.display.get_surface()
        assert pygame.display.get_caption()[0] == "toy in plain" and surface.get_size() == (640, 350)
        shown = np.frombuffer(pygame.image.tobytes(surface, "RGB"), np.uint8).reshape(350, 640, 3)
        assert np.array_equal(shown, drawn.picture())
        drawn.close()
        assert not pygame.display.get_init()
    drawn.close()
