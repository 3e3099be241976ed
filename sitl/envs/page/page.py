# SPDX-License-Identifier: BSD-3-Clause
"""The page of an environment."""

from __future__ import annotations

from typing import Any

from sitl.view.layout import GRID, LAYOUTS
from sitl.view.page import Page

from ..session import Session
from .source import EnvSource

_PLOTTED = ("reward", "return", "action[0]")
"""Signals that are plotted from the beginning."""


class EnvPage(Page):
    """A page of an environment, for one robot or many.

    Args:
        session: of the environment.
        name: of the environment.
        port: on this machine; 0: a free one.

    Raises:
        MissingExtra: the library that draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
    """

    def __init__(self, session: Session, name: str, port: int = 0) -> None:
        self.env_source = source = EnvSource(session, name)
        super().__init__(source, port)
        for signal in _PLOTTED:
            self.plots.add(signal)

    def _add_looks(self, gui: Any) -> None:
        if self.env_source.stage.company:
            self.layout = gui.add_dropdown("Robots", LAYOUTS, initial_value=GRID, hint="each in a world of its own")
            self.layout.on_update(self.guarded(lambda event: self._lay_out(event.target.value)))

    def _lay_out(self, layout: str) -> None:
        self.env_source.layout = layout
        self.scene.place_world(self.env_source.stage.copies if layout == GRID else None)
        self.cameras.choose(self.cameras.view)
