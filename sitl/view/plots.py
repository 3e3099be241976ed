# SPDX-License-Identifier: BSD-3-Clause
"""Plots of signals that the user chooses by name, over the last seconds."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import SitlError
from .frame import Frame, Source
from .incoming import check_value

_LINES = ("#2e86de", "#e67e22", "#27ae60", "#c0392b", "#8e44ad", "#16a085", "#f39c12", "#34495e")
_MOST = 6
"""Plots at once."""
_TOGETHER = 4
"""Signals of a plot."""
_OWN = "a plot of its own"
_KEPT = 900
"""Samples of each: half a minute at 30 frames a second."""
_OFFERED = 40
"""Names in the list that a search gives."""
_NOTHING = "no signal has this in its name"


class Plot:
    """Signals over time: one, or several together.

    Args:
        gui: of the page.
        name: of the first signal.
        colour: number of its colour.
    """

    def __init__(self, gui: Any, name: str, colour: int) -> None:
        self._gui, self._first_colour = gui, colour
        self.names = [name]
        self._times, self._values = np.zeros(_KEPT), np.zeros((1, _KEPT))
        self._count = 0
        self._node: Any = None
        self._draw_axes()

    @property
    def title(self) -> str:
        """The names of its signals."""
        return ", ".join(self.names)

    def join(self, name: str) -> None:
        """Draw another signal in it, from now on."""
        self.names.append(name)
        self._values = np.vstack([self._values, np.full(_KEPT, np.nan)])
        self._draw_axes()

    def _draw_axes(self) -> None:
        series: list[dict[str, Any]] = [{"label": "t"}]
        for k, name in enumerate(self.names):
            colour = _LINES[(self._first_colour + k) % len(_LINES)]
            scale = "y" if _group(name) == _group(self.names[0]) else "right"
            series.append({"label": f"{name}{whose(name)}", "stroke": colour, "width": 1.5, "scale": scale})
        scales: dict[str, Any] = {"x": {"time": False, "auto": True}, "y": {"auto": True}}
        axes: list[dict[str, Any]] = [{"scale": "x"}, {"scale": "y"}]
        if any(each.get("scale") == "right" for each in series):
            scales["right"] = {"auto": True}
            axes.append({"scale": "right", "side": 1, "grid": {"show": False}})
        data = (np.zeros(1),) * (1 + len(self.names)) if self._count < 2 else self.samples
        order = None if self._node is None else self._node.order
        self.remove()
        self._node = self._gui.add_uplot(
            data, series=tuple(series), scales=scales, axes=tuple(axes), legend={"show": True}, height=150,
            title=self.title, order=order,
        )  # fmt: skip

    def add(self, time: float, values: Mapping[str, float]) -> None:
        """A sample of all signals; time [s] that has gone back begins anew."""
        if self._count and time < self._times[self._count - 1]:
            self._count = 0
        if self._count == _KEPT:  # forget the older half
            half = _KEPT // 2
            self._times[:half], self._values[:, :half] = self._times[-half:], self._values[:, -half:]
            self._count = half
        self._times[self._count] = time
        self._values[:, self._count] = [values.get(name, np.nan) for name in self.names]
        self._count += 1

    @property
    def samples(self) -> tuple[np.ndarray[Any, Any], ...]:
        """Times [s], and values of each signal."""
        n = self._count
        return (self._times[:n].copy(), *(row[:n].copy() for row in self._values))

    def draw(self) -> None:
        """Send it to the page."""
        if self._count > 1:
            self._node.data = self.samples

    def remove(self) -> None:
        """Take it off the page."""
        if self._node is not None:
            self._node.remove()


def whose(name: str) -> str:
    """Whether a signal of a vehicle is what it says or believes, or the truth; nothing of other signals."""
    part = name.partition(".")[0]
    if part.isupper() or part in ("autopilot", "sensors", "actuators"):
        return " (vehicle)"
    return " (truth)" if part == "physics" else ""


def _group(name: str) -> str:
    """The message or the part of the record that a signal is of: its signals share an axis."""
    return name.rpartition(".")[0]


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
        self._changing = threading.Lock()
        """Users choose plots in another thread than the one that draws them."""
        self._search = gui.add_text("Signal", "", hint="part of a name, such as ATTITUDE or physics.body.pos")
        self._choice = gui.add_dropdown("Found", ("-",))
        self._into = gui.add_dropdown("Into", (_OWN,), hint="signals of another message have their axis on the right")
        self._add = gui.add_button("Plot it")
        self._clear = gui.add_button("Remove all plots")
        self.paused = gui.add_checkbox("Plots stand still", False)
        self._search.on_update(guard(lambda event: self._offer()))
        self._add.on_click(guard(lambda event: self._add_chosen()))
        self._clear.on_click(guard(lambda event: self.clear()))

    def _offer(self) -> None:
        wanted = self._search.value.strip().lower()
        found = [name for name in self._source.signal_names() if wanted in name.lower()] if wanted else []
        self._choice.options = tuple(found[:_OFFERED]) or (_NOTHING,)

    def _add_chosen(self) -> None:
        for widget in (self._choice, self._into):
            check_value(widget, widget.value)
        into = next((p for p in self._plots if p.title == self._into.value), None)
        self.add(self._choice.value, None if into is None else into.names[0])

    @property
    def names(self) -> tuple[str, ...]:
        """Signals that are plotted."""
        return tuple(name for plot in self._plots for name in plot.names)

    def find(self, name: str) -> Plot:
        """The plot of a signal."""
        return next(plot for plot in self._plots if name in plot.names)

    def add(self, name: str, beside: str | None = None) -> None:
        """Plot a signal.

        Args:
            name: of the signal.
            beside: a signal in whose plot it is drawn; None: it has a plot of its own.

        Raises:
            SitlError: there is no such signal, or there are plots enough, or signals in that plot.
        """
        if name in self.names:
            return
        if beside is None and len(self._plots) >= _MOST:
            raise SitlError(f"{name}: {_MOST} plots are the most; remove some")
        if beside is not None and len(self.find(beside).names) >= _TOGETHER:
            raise SitlError(f"{name}: {_TOGETHER} signals in a plot are the most")
        self._source.choose_signals((*self.names, name))
        with self._changing:
            if beside is None:
                self._plots.append(Plot(self._gui, name, len(self.names)))
            else:
                self.find(beside).join(name)
        self._into.options = (_OWN, *(plot.title for plot in self._plots))

    def clear(self) -> None:
        """Remove all."""
        self._source.choose_signals(())
        with self._changing:
            for plot in self._plots:
                plot.remove()
            self._plots = []
        self._into.options = (_OWN,)

    def show(self, frame: Frame, draw: bool) -> None:
        """Take a moment's values; ``draw``: and send them to the page."""
        if self.paused.value:
            return
        with self._changing:
            for plot in self._plots:
                if any(name in frame.signals for name in plot.names):
                    plot.add(frame.time_us * 1e-6, frame.signals)
                    if draw:
                        plot.draw()
