# SPDX-License-Identifier: BSD-3-Clause
"""A pilot's sticks on the page, as sliders: MANUAL_CONTROL, sent again and again while they are held."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from .incoming import check_value

_FULL = 1000
"""Greatest value of an axis."""
_FLYING = (("Roll", -100.0, 0.0), ("Pitch", -100.0, 0.0), ("Throttle", 0.0, 0.0), ("Yaw", -100.0, 0.0))
_DRIVING = (("Steering", -100.0, 0.0), ("Throttle", -100.0, 0.0))
"""Sticks: name, least value and where it is at first [%]; a copter arms with its throttle down."""
_MIDDLE = 50.0
"""Of a copter's throttle: it stays at its height in ALT_HOLD and LOITER [%]."""


class Axes(NamedTuple):
    """Fields of MANUAL_CONTROL."""

    x: int
    """Forward."""
    y: int
    """To the right."""
    z: int
    """Throttle; of a copter 0 .. 1000."""
    r: int
    """Nose to the right."""


class Sticks:
    """The sliders, and whether they are held.

    Args:
        gui: of the page.
        hold: is given what reads the axes when they change; that gives None when they are let go.
        flies: a copter's; False: a rover's.
    """

    def __init__(self, gui: Any, hold: Callable[[Callable[[], Axes | None]], None], flies: bool) -> None:
        self._hold, self._flies = hold, flies
        self.held = gui.add_checkbox("Hold the sticks", False, hint="MANUAL_CONTROL, ten times a second")
        self.sliders = {
            name: gui.add_slider(name, min=low, max=100.0, step=1.0, initial_value=at, hint="[%]")
            for name, low, at in (_FLYING if flies else _DRIVING)
        }
        self.centre = gui.add_button("Centre them", hint="throttle at its middle")
        for widget in (self.held, *self.sliders.values()):
            widget.on_update(lambda event: self._changed())
        self.centre.on_click(lambda event: self._to_centre())

    @property
    def axes(self) -> Axes:
        """What the sliders say.

        Raises:
            OptionError: one of them is not where it can be.
        """
        for slider in self.sliders.values():
            check_value(slider, slider.value)
        value = {name: round(float(slider.value) * 0.01 * _FULL) for name, slider in self.sliders.items()}
        if self._flies:
            return Axes(value["Pitch"], value["Roll"], value["Throttle"], value["Yaw"])
        return Axes(0, value["Steering"], value["Throttle"], 0)

    def _changed(self) -> None:
        self._hold(lambda: self.axes if self.held.value else None)

    def _to_centre(self) -> None:
        for name, slider in self.sliders.items():
            slider.value = _MIDDLE if self._flies and name == "Throttle" else 0.0
