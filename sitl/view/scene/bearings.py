# SPDX-License-Identifier: BSD-3-Clause
"""Which way north is, and how long a metre is: an arrow and a bar beside the vehicle, which grow with what is seen."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..frame import Points

LENGTHS = (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
"""Of arrow and bar [m]."""
_ARROW, _BAR = (192, 57, 43), (40, 40, 48)


def length_for(span: float) -> float:
    """The greatest of LENGTHS that is not above ``span`` [m]."""
    return max((each for each in LENGTHS if each <= span), default=LENGTHS[0])


class Bearings:
    """The arrow and the bar, on the ground or in the air."""

    def __init__(self, scene: Any) -> None:
        self._node = scene.add_frame("/stage/bearings", show_axes=False)
        none = np.zeros((0, 2, 3), np.float32)
        self.arrow, self.bar = (
            scene.add_line_segments(f"/stage/bearings/{name}", none, colour, thickness=3.0, thickness_units="screen")
            for name, colour in (("arrow", _ARROW), ("bar", _BAR))
        )
        self.north = scene.add_label("/stage/bearings/north", "N", anchor="bottom-center", font_screen_scale=0.9)
        self.scale = scene.add_label("/stage/bearings/scale", "", anchor="top-center", font_screen_scale=0.8)
        self.length = 0.0
        """Of both [m]."""

    def show(self, at: tuple[float, float, float], span: float) -> None:
        """Draw them south-west of a position of the scene, at its height, for ``span`` metres that are seen around
        it."""
        x, y, z = at
        length = length_for(span)
        if length != self.length:
            self.length = length
            self.arrow.points, self.bar.points = arrow(length), bar(length)
            self.north.position, self.scale.position = (length, 0.0, 0.0), (0.0, -0.5 * length, 0.0)
            self.scale.text = f"{length:g} m"
        self._node.position = (x - 0.7 * length, y + 0.7 * length, z + 0.02 * length)


def arrow(length: float) -> Points:
    """Lines of an arrow to the north, shape (3, 2, 3) [m]."""
    head, side = 0.8 * length, 0.08 * length
    tip = (length, 0.0, 0.0)
    return np.array([((0, 0, 0), tip), (tip, (head, side, 0)), (tip, (head, -side, 0))], np.float32)


def bar(length: float) -> Points:
    """Lines of a bar to the east with its ends, shape (3, 2, 3) [m]."""
    half = 0.06 * length
    ends = [((-half, -at, 0.0), (half, -at, 0.0)) for at in (0.0, length)]
    return np.array([((0, 0, 0), (0, -length, 0)), *ends], np.float32)
