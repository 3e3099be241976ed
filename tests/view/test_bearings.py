# SPDX-License-Identifier: BSD-3-Clause
"""North and scale in the scene, and where cameras of narrow windows look."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.core.vectors import Quat, Vec3
from sitl.view.axes import to_scene
from sitl.view.cameras import FOLLOW, NARROW, TOP, Cameras
from sitl.view.frame import Frame
from sitl.view.scene.bearings import LENGTHS, arrow, bar, length_for

FRAME = Frame(time_us=0, pos=Vec3(1.0, 2.0, -10.0), q=Quat(1.0, 0.0, 0.0, 0.0), vel=Vec3(0.0, 0.0, 0.0))


def test_the_arrow_points_north_and_the_bar_east() -> None:
    tip, end = arrow(2.0)[0][1], bar(2.0)[0][1]
    assert tuple(tip) == pytest.approx(to_scene(Vec3(2.0, 0.0, 0.0)))
    assert tuple(end) == pytest.approx(to_scene(Vec3(0.0, 2.0, 0.0)))


@pytest.mark.parametrize(("span", "length"), [(0.1, 0.2), (0.99, 0.5), (1.0, 1.0), (73.0, 50.0), (1e6, LENGTHS[-1])])
def test_their_length_is_a_round_number_of_what_is_seen(span: float, length: float) -> None:
    assert length_for(span) == length


@pytest.mark.parametrize("view", [FOLLOW, TOP])
def test_a_narrow_window_shows_the_vehicle_above_the_panel(view: str) -> None:
    """The panel covers its lower three fifths."""
    cameras = Cameras(SimpleNamespace(position=(0.0, 0.0, 0.0)), 1.0, view)

    def height_on_screen(width: int) -> float:
        camera: Any = SimpleNamespace(image_width=width, image_height=760)
        cameras._place(camera, FRAME)
        eye, aim, up = (np.array(each, float) for each in (camera.position, camera.look_at, camera.up_direction))
        ahead = (aim - eye) / np.linalg.norm(aim - eye)
        if view == TOP:
            up = np.array([1.0, 0.0, 0.0])
        above = up - ahead * (up @ ahead)
        above /= np.linalg.norm(above)
        return float((-eye @ above) / (-eye @ ahead) / np.tan(np.radians(37.5)))  # 1: the upper edge, -1: the lower one

    assert height_on_screen(NARROW) == pytest.approx(0.0, abs=0.05)
    assert 0.3 < height_on_screen(400) < 0.8
