# SPDX-License-Identifier: BSD-3-Clause
"""The page of flights that were kept, one or several: a time bar, events to jump to, modes as a band, plots."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ..core.whole_file import write_whole
from ..run.playback import Player
from . import horizon, page_library
from .cameras import FREE, VIEWS, Cameras
from .colours import css, of_ends, of_mode
from .flights import Flight, Floats
from .guard import Guard
from .incoming import check_value
from .page import LOCAL, free_port
from .scene import surroundings
from .scene.bearings import Bearings
from .scene.vehicle import VehicleNodes

COLOURS = ((46, 134, 222), (230, 126, 34), (39, 174, 96), (192, 57, 43), (142, 68, 173), (22, 160, 133))
SPEEDS = ("0.1", "0.5", "1", "2", "5", "10", "50")
_PLOTTED = (
    ("height above home, as logged [m]", "down", -1.0), ("north of home, as logged [m]", "north", 1.0),
    ("east of home, as logged [m]", "east", 1.0),
)  # fmt: skip
_SAVED_FRAMES = 1200
"""Of a saved page, at most."""
_SAVED_RATE = 10.0
"""Frames a second of a saved page while that is few enough."""
Series = Mapping[str, tuple[Floats, Floats]]


class FlightScene:
    """Flights in the scene: the whole path of each, and where it is at a moment."""

    def __init__(self, server: Any, flights: Sequence[Flight]) -> None:
        scene = server.scene
        scene.set_up_direction("+z")
        self.stage = scene.add_frame("/stage", show_axes=False)
        """All of it (``cameras``)."""
        scene.configure_default_lights(cast_shadow=True)
        surroundings.draw(scene, None)
        self._show_bearings(Bearings(scene), flights[0].positions())
        self.vehicles, self._labels = [], []
        size = flights[0].shape.size
        for k, flight in enumerate(flights):
            name, positions = f"/stage/flights/{k}", flight.positions().astype(np.float32)
            self.vehicles.append(VehicleNodes(scene, f"{name}/vehicle", flight.shape))
            colours: Any = COLOURS[k % len(COLOURS)]
            if len(flights) == 1:
                each = of_ends([of_mode(flight.mode(t)) for t in flight.track.t])
                colours = np.stack([each[:-1], each[:-1]], axis=1)
            lines = np.stack([positions[:-1], positions[1:]], axis=1)
            scene.add_line_segments(f"{name}/path", lines, colours, thickness=2.5, thickness_units="screen")
            anchor = "bottom-center" if k % 2 == 0 else "top-center"  # two that fly together can both be read
            label = scene.add_label(f"{name}/label", flight.name, anchor=anchor, font_screen_scale=0.8)
            self._labels.append(label)
            for at, seq in flight.track.items if k == 0 else ():  # others' are in the same places, or in the list
                here = [np.interp(at, flight.track.t, positions[:, axis]) for axis in range(3)]
                scene.add_icosphere(f"{name}/item{seq}", radius=0.12 * size, color=(240, 150, 20), position=here)
                scene.add_label(f"{name}/item{seq}/label", f"item {seq}", font_screen_scale=0.7)
        none = np.zeros((0, 2, 3), np.float32)
        self._gap = scene.add_line_segments(
            "/stage/flights/gap", none, (192, 57, 43), thickness=2.0, thickness_units="screen"
        )
        self._flights, self._size = flights, size

    @staticmethod
    def _show_bearings(bearings: Bearings, positions: Floats) -> None:
        """Beside the whole path."""
        low, high = positions.min(axis=0), positions.max(axis=0)
        bearings.show((float(low[0]), float(high[1]), 0.0), 0.4 * float((high - low).max()))

    def show(self, time: float) -> list[Any]:
        """Draw a moment [s]; gives the frames of it."""
        frames = [flight.frame(min(time, flight.length)) for flight in self._flights]
        shown = zip(self._flights, self.vehicles, self._labels, frames, strict=True)
        for k, (flight, nodes, label, frame) in enumerate(shown):
            nodes.show(frame)
            x, y, z = nodes.body.position
            label.position = (x, y, z + (0.8 if k % 2 == 0 else -0.8) * self._size)
            label.text = f"{flight.name}  {time:.1f} s  {frame.mode}"
        if len(frames) > 1:
            positions = [nodes.body.position for nodes in self.vehicles[:2]]
            self._gap.points = np.array([positions], np.float32)
        return frames


class FlightPage(Guard):
    """A page of one or more flights with a common clock.

    Args:
        flights: the first is the one that others are compared with.
        differences: curves besides: name -> (times [s], values).
        port: on this machine; 0: a free one.

    Raises:
        MissingExtra: the library that draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
    """

    def __init__(self, flights: Sequence[Flight], differences: Series | None = None, port: int = 0) -> None:
        page_library.require()
        self.flights = flights
        title = flights[0].name if len(flights) == 1 else f"{len(flights)} flights"
        self.server = page_library.serve(LOCAL, free_port(port), title)
        self.address = f"http://{LOCAL}:{self.server.get_port()}"
        self.scene = FlightScene(self.server, flights)
        self.cameras = Cameras(self.scene.stage, flights[0].shape.size, FREE)
        self._look_at_all()
        self.begin = min(float(flight.track.t[0]) for flight in flights)
        """First sample [s]: an on-board log may begin minutes after power-on."""
        self.length = max(flight.length for flight in flights)
        self.events = [(event.time, f"{flight.name}: {event.text}" if len(flights) > 1 else event.text)
                       for flight in flights for event in flight.events()]  # fmt: skip
        self.events.sort()
        self.frames: list[Any] = []
        """What is shown, of each flight."""
        self._add_widgets(differences or {})
        self._moves_bar = False
        self.player = Player(self.length, lambda time: self.safely(lambda: self._show(time)), begin=self.begin)
        self.player.go_to(self.begin)

    def _look_at_all(self) -> None:
        """Browsers begin with a view of the whole path."""
        positions = self.flights[0].positions()
        low, high = positions.min(axis=0), positions.max(axis=0)
        middle, far = 0.5 * (low + high), float((high - low).max()) + 4.0 * self.flights[0].shape.size
        camera = self.server.initial_camera
        camera.position = tuple(middle + far * np.array([-0.7, 0.5, 0.5]))
        camera.look_at = tuple(middle)

    def _add_widgets(self, differences: Series) -> None:
        gui = self.server.gui
        gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
        gui.main_panel.dock_right()
        low, high = self.begin, max(self.length, self.begin + 0.1)
        self.bar = gui.add_slider("Time [s]", min=low, max=high, step=0.05, initial_value=low)
        self._band = gui.add_html(band(self.flights, self.begin, self.length))
        self.play = gui.add_button("Play")
        self.stop = gui.add_button("Stop")
        self.speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        names = tuple(f"{t:.1f} s  {text}" for t, text in self.events) or ("none",)
        self.event = gui.add_dropdown("Jump to", names, initial_value=names[0])
        view = gui.add_dropdown("Camera", VIEWS, initial_value=self.cameras.view)
        self._state = gui.add_html("")
        self._add_plots(gui, differences)
        for widget, act in (
            (self.bar, self._bar_moved), (self.speed, self._set_speed), (view, lambda event: self._look(view.value)),
            (self.event, lambda event: self.jump(names.index(self.event.value))),
        ):  # fmt: skip
            widget.on_update(self.guarded(act))
        self.play.on_click(self.guarded(lambda event: self.player.play()))
        self.stop.on_click(self.guarded(lambda event: self.player.stop()))

    def _set_speed(self, event: Any) -> None:
        check_value(self.speed, self.speed.value)
        self.player.speed = float(self.speed.value)

    def _add_plots(self, gui: Any, differences: Series) -> None:
        for title, column, sign in _PLOTTED:
            t = self.flights[0].track.t
            rows = [sign * np.interp(t, each.track.t, each.track[column], right=np.nan) for each in self.flights]
            series = [{"label": each.name, "stroke": css(COLOURS[k % len(COLOURS)]), "width": 1.5}
                      for k, each in enumerate(self.flights)]  # fmt: skip
            self._plot(gui, title, (t, *rows), series)
        for name, (t, values) in differences.items():
            self._plot(gui, name, (t, values), [{"label": name, "stroke": "#c0392b", "width": 1.5}])

    @staticmethod
    def _plot(gui: Any, title: str, data: tuple[Floats, ...], series: list[dict[str, Any]]) -> None:
        scales = {"x": {"time": False, "auto": True}, "y": {"auto": True}}
        gui.add_uplot(data, series=({"label": "t"}, *series), scales=scales, title=title, height=150)

    def _bar_moved(self, event: Any) -> None:
        if not self._moves_bar:
            check_value(self.bar, self.bar.value)
            self.player.go_to(float(self.bar.value))

    def _look(self, view: str) -> None:
        self.cameras.choose(view)
        if self.frames:
            self.cameras.show(self.server.get_clients(), self.frames[0])

    def jump(self, number: int) -> None:
        """Go to an event by its number in ``events``."""
        if self.events:
            self.player.go_to(self.events[number][0])

    def _show(self, time: float) -> None:
        with self.server.atomic():
            self.frames = self.scene.show(time)
        self._state.content = state(self.flights, self.frames, time)
        if abs(self.bar.value - time) > 0.025:
            self._moves_bar = True
            self.bar.value = round(time, 2)
            self._moves_bar = False
        self.cameras.show(self.server.get_clients(), self.frames[0])

    def save(self, path: Path, frames: int = _SAVED_FRAMES) -> None:
        """Write the scene and its course as one file that a browser opens from disk: no server, no network.

        Args:
            path: of the file.
            frames: moments in it, at most.

        Raises:
            SitlError: the file cannot be written.
        """
        step = max(1.0 / _SAVED_RATE, (self.length - self.begin) / frames)
        self.scene.show(self.begin)
        serializer = self.server.get_scene_serializer()
        for time in np.arange(self.begin + step, self.length, step):
            serializer.insert_sleep(step)
            self.scene.show(float(time))
        text = serializer.as_html()
        write_whole(path, text, title=f"page {str(path)!r}")

    def close(self) -> None:
        """Close the page."""
        self.player.close()
        page_library.stop(self.server)


def band(flights: Sequence[Flight], begin: float, end: float) -> str:
    """Modes between two times [s] as coloured bars, a row a flight, with marks where items were reached."""

    def across(time: float) -> float:
        return 100.0 * (min(max(time, begin), end) - begin) / (end - begin)

    rows = []
    for k, flight in enumerate(flights):
        modes = [*flight.track.modes, (flight.length, "")]
        for (since, mode), (until, _) in pairwise(modes):
            x, w = across(since), across(until) - across(since)
            if w > 0.0:
                rows.append(
                    f'<rect x="{x:.2f}%" y="{14 * k}" width="{w:.2f}%" height="12" fill="{css(of_mode(mode))}">'
                    f"<title>{escape(flight.name)}: {escape(mode)} from {since:.1f} s</title></rect>"
                )
        rows += [
            f'<rect x="{across(t):.2f}%" y="{14 * k}" width="1.5" height="12" fill="#fff"/>'
            for t, _ in flight.track.items
        ]
    used = sorted({mode for flight in flights for _, mode in flight.track.modes})
    spans = (f'<span style="color:{css(of_mode(m))};margin-right:0.8em">&#9632; {escape(m)}</span>' for m in used)
    legend = "".join(spans)
    return (
        f'<div style="padding:0 0.6em"><svg width="100%" height="{14 * len(flights)}">{"".join(rows)}</svg>'
        f'<div style="font-size:0.75em">{legend}</div></div>'
    )


def state(flights: Sequence[Flight], frames: Sequence[Any], time: float) -> str:
    """The flights at a moment, as HTML."""
    rows = []
    for k, (flight, frame) in enumerate(zip(flights, frames, strict=True)):
        speed = math.hypot(frame.vel.x, frame.vel.y)
        colour = css(COLOURS[k % len(COLOURS)]) if len(flights) > 1 else css(of_mode(frame.mode))
        rows.append(
            f'<tr><td style="color:{colour}">&#9632; {escape(flight.name)}</td><td>{escape(frame.mode)}</td>'
            f"<td>{'armed' if frame.armed else 'disarmed'}</td><td>{-frame.pos.z:.1f} m</td>"
            f"<td>{speed:.1f} m/s</td></tr>"
        )
    heads = "<tr style='color:#888'><td>as logged</td><td></td><td></td><td>above home</td><td>ground speed</td></tr>"
    gap = ""
    if len(frames) > 1:
        gap = f"<div>{math.dist(frames[0].pos, frames[1].pos):.2f} m apart at {time:.1f} s</div>"
    return (
        f'<div style="padding:0 0.6em;font-size:0.8em"><table style="width:100%">{heads}{"".join(rows)}</table>{gap}'
        f"{horizon.draw(frames[0])}</div>"
    )
