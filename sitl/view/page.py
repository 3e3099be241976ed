# SPDX-License-Identifier: BSD-3-Clause
"""The page: a server on this machine, and a thread that draws what it is given. Whoever opens the address sees
the same.

Frames come to it through a slot for one: while it draws, the vehicle goes on, and what is drawn next is the newest.
"""

from __future__ import annotations

import socket
import threading
import time
import traceback
from typing import Any, cast

from ..errors import SitlError
from . import page_library
from .cameras import VIEWS, Cameras
from .frame import CompanyOfSources, Frame, Source
from .guard import Guard
from .incoming import check_value
from .panel import Panel
from .plots import Plots
from .scene.scene import Scene
from .scene.trail import BY_MODE, BY_SPEED

LOCAL = "127.0.0.1"
SHARE = 0.05
"""Of a processor's time that drawing may take: where drawing is slow, there are fewer frames."""
_PANEL_EVERY = 3
"""Instruments and plots are sent with every third frame: ten times a second."""


class PageAddressError(SitlError, ValueError):
    """A port that the page cannot have."""


class Page(Guard):
    """A page that shows one vehicle.

    Args:
        source: of the frames.
        port: on this machine; 0: a free one.

    Raises:
        MissingExtra: the library that draws it is not installed.
        PageAddressError: the port is taken.
    """

    def __init__(self, source: Source, port: int = 0) -> None:
        page_library.require()
        self.source = source
        self.server = page_library.serve(LOCAL, free_port(port), source.stage.title)
        self.port = int(self.server.get_port())
        self.address = f"http://{LOCAL}:{self.port}"
        self.frame: Frame | None = None
        """The last one that was drawn."""
        self._slot: Any = None
        self._factor = 0.0
        self._filled = threading.Condition()
        self._drawn = 0
        self._closed = False
        gui = self.server.gui
        gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
        gui.main_panel.dock_right()
        self._add_choice(gui, len(source.stage.company))
        self.scene = Scene(self.server, source.stage)
        self.cameras = Cameras(self.scene.stage, source.stage.shape.size)
        self.tabs = self._add_instruments(gui)
        self._thread = threading.Thread(target=self._draw_all, name="sitl-view", daemon=True)
        self._thread.start()

    def _add_choice(self, gui: Any, count: int) -> None:
        """How one of several vehicles is chosen."""
        if count == 0:
            return
        number = gui.add_number("Vehicle", 1, min=1, max=count, step=1, hint=f"1 to {count}: shown in full")
        source = cast(CompanyOfSources, self.source)

        def choose(event: Any) -> None:
            check_value(number, number.value)
            source.choose(int(number.value) - 1)

        number.on_update(self.guarded(choose))
        self.vehicle_number = number

    def _add_instruments(self, gui: Any) -> Any:
        tabs = gui.add_tab_group()
        with tabs.add_tab("Flight"):
            self.panel = Panel(gui)
        with tabs.add_tab("Look"):
            view = gui.add_dropdown("Camera", VIEWS, initial_value=self.cameras.view)
            view.on_update(self.guarded(lambda event: self.cameras.choose(event.target.value)))
            colours = gui.add_dropdown("Trail's colour", (BY_MODE, BY_SPEED), initial_value=BY_MODE)
            colours.on_update(self.guarded(lambda event: setattr(self.scene.trail, "colours", event.target.value)))
            clear = gui.add_button("Forget the trail")
            clear.on_click(self.guarded(lambda event: self.scene.trail.clear()))
            self._add_looks(gui)
        with tabs.add_tab("Plots"):
            self.plots = Plots(gui, self.source, self.guarded)
        self.view = view
        return tabs

    def _add_looks(self, gui: Any) -> None:
        """Further widgets of the tab Look, of some pages."""

    # ------------------------------------------------------------------ from the vehicle's thread

    @property
    def is_seen(self) -> bool:
        """A browser has it open."""
        return bool(self.server.get_clients())

    @property
    def is_free(self) -> bool:
        """All that it was given is drawn."""
        return self._slot is None

    def attend(self) -> None:
        """Do what users have asked for (``sitl.run.watched.Viewer``): of this page, nothing."""

    def capture(self, factor: float) -> None:
        """Take what the source has now; ``factor``: simulated time by wall time."""
        captured = self.source.capture()
        with self._filled:
            self._slot, self._factor = captured, factor
            self._filled.notify()

    # ------------------------------------------------------------------ in its own

    def _draw_all(self) -> None:
        while True:
            with self._filled:
                self._filled.wait_for(lambda: self._closed or self._slot is not None)
                if self._closed:
                    return
                captured, factor = self._slot, self._factor
            spent = self.show_safely(captured, factor)
            with self._filled:
                self._filled.wait_for(lambda: self._closed, timeout=spent * (1.0 / SHARE - 1.0))
                if self._slot is captured:  # else there is something newer already
                    self._slot = None
                self._filled.notify_all()

    def show_safely(self, captured: Any, factor: float) -> float:
        """Draw what was captured, whatever becomes of it; returns the processor's time that it took [s]."""
        begin = time.thread_time()
        try:
            self.show(self.source.frame(captured), factor)
        except Exception:  # the flight is more than its picture: say it, and go on
            traceback.print_exc()
        return time.thread_time() - begin

    def show(self, frame: Frame, factor: float = 1.0) -> None:
        """Draw a moment."""
        draws = self._drawn % _PANEL_EVERY == 0
        self._drawn += 1
        with self.server.atomic():
            self.scene.show(frame, self.cameras.span(frame))
            if draws:
                self.panel.show(frame, f"{factor:.1f} x")
            self.panel.show_texts(frame.texts)
        self.plots.show(frame, draws)
        self.cameras.show(self.server.get_clients(), frame)
        self.frame = frame

    def wait_drawn(self) -> None:
        """Wait until all that it was given is drawn."""
        with self._filled:
            self._filled.wait_for(lambda: self._slot is None or self._closed)

    def close(self) -> None:
        """Close the page; browsers say that the connection is lost."""
        with self._filled:
            self._closed = True
            self._filled.notify_all()
        self._thread.join(timeout=5.0)
        page_library.stop(self.server)


def free_port(port: int) -> int:
    """The port itself when it is free, any free one for 0.

    Raises:
        PageAddressError: somebody has it.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        try:
            probe.bind((LOCAL, port))
        except OSError as error:
            raise PageAddressError(f"port {port} for the page cannot be had: {error.strerror or error}") from None
        return int(probe.getsockname()[1])
