# SPDX-License-Identifier: BSD-3-Clause
"""Plots of signals that the user chooses by name, over the last seconds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import SitlError
from .frame import Frame, Source

_LINES = ("#2e86de", "#e67e22", "#27ae60", "#c0392b", "#8e44ad", "#16a085", "#f39c12", "#34495e")
_MOST = 6
"""Plots at once."""
_KEPT = 900
"""Samples of each: half a minute at 30 frames a second."""
_OFFERED = 40
"""Names in the list that a search gives."""
_NOTHING = "no signal has this in its name"


class Plot:
    """One signal over time."""

    def __init__(self, gui: Any, name: str, colour: str) -> None:
        self.name = name
        self._times, self._values = np.zeros(_KEPT), np.zeros(_KEPT)
        self._count = 0
        self._node = gui.add_uplot(
            (np.zeros(1), np.zeros(1)),
            series=({"label": "t"}, {"label": name, "stroke": colour, "width": 1.5}),
            scales={"x": {"time": False, "auto": True}, "y": {"auto": True}},
            legend={"show": True}, height=150, title=name,
        )  # fmt: skip

    def add(self, time: float, value: float) -> None:
        """A sample; time [s] that has gone back begins anew."""
        if self._count and time < self._times[self._count - 1]:
            self._count = 0
        if self._count == _KEPT:  # forget the older half
            half = _KEPT // 2
            self._times[:half], self._values[:half] = self._times[-half:], self._values[-half:]
            self._count = half
        self._times[self._count], self._values[self._count] = time, value
        self._count += 1

    @property
    def samples(self) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        """Times [s] and values."""
        return self._times[: self._count].copy(), self._values[: self._count].copy()

    def draw(self) -> None:
        """Send it to the page."""
        if self._count > 1:
            self._node.data = self.samples

    def remove(self) -> None:
        """Take it off the page."""
        self._node.remove()


class Plots:
    """The plots, and how a signal is found: part of its name, then a choice.

    Args:
        gui: of the page.
        source: of the frames.
        guard: wraps what is done on a click, so that an error is shown to who clicked.
    """

    def __init__(self, gui: Any, source: Source, guard: Callable[..., Any]) -> None:
        self._gui, self._source = gui, source
        self._plots: list[Plot] = []
        self._search = gui.add_text("Signal", "", hint="part of a name, such as ATTITUDE or physics.body.pos")
        self._choice = gui.add_dropdown("Found", ("-",))
        self._add = gui.add_button("Plot it")
        self._clear = gui.add_button("Remove all plots")
        self.paused = gui.add_checkbox("Plots stand still", False)
        self._search.on_update(guard(lambda event: self._offer()))
        self._add.on_click(guard(lambda event: self.add(self._choice.value)))
        self._clear.on_click(guard(lambda event: self.clear()))

    def _offer(self) -> None:
        wanted = self._search.value.strip().lower()
        found = [name for name in self._source.signal_names() if wanted in name.lower()] if wanted else []
        self._choice.options = tuple(found[:_OFFERED]) or (_NOTHING,)

    @property
    def names(self) -> tuple[str, ...]:
        """Signals that are plotted."""
        return tuple(plot.name for plot in self._plots)

    def find(self, name: str) -> Plot:
        """The plot of a signal."""
        return next(plot for plot in self._plots if plot.name == name)

    def add(self, name: str) -> None:
        """Plot a signal.

        Raises:
            SitlError: there is no such signal, or there are plots enough.
        """
        if name in self.names:
            return
        if len(self._plots) >= _MOST:
            raise SitlError(f"{name}: {_MOST} plots are the most; remove some")
        self._source.choose_signals((*self.names, name))
        self._plots.append(Plot(self._gui, name, _LINES[len(self._plots) % len(_LINES)]))

    def clear(self) -> None:
        """Remove all."""
        self._source.choose_signals(())
        for plot in self._plots:
            plot.remove()
        self._plots = []

    def show(self, frame: Frame, draw: bool) -> None:
        """Take a moment's values; ``draw``: and send them to the page."""
        if self.paused.value:
            return
        for plot in self._plots:
            if plot.name in frame.signals:
                plot.add(frame.time_us * 1e-6, frame.signals[plot.name])
                if draw:
                    plot.draw()
