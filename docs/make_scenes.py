# SPDX-License-Identifier: BSD-3-Clause
"""Scenes in pages of the site: flights that a reader turns, zooms and plays in the page itself, one file each.

A comment ``<!-- scene: NAME -->`` in a page stands for one. ``docs/conf.py`` lets the build make them; the repository
keeps none.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from sitl import Simulation
from sitl.client import Client
from sitl.missions.comparison import flight
from sitl.missions.view import together
from sitl.recording.recorder import Recorder
from sitl.view.flight_page import FlightPage

ROOT = Path(__file__).resolve().parents[1]
GOLDEN = ROOT / "tests" / "golden" / "golden"
MARK = re.compile(r"^<!-- scene: ([\w-]+) -->$", re.M)
MOMENTS = 200
"""In a file, at most."""


def first_flight() -> list[flight.Flight]:
    """The flight of the tutorial."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "first-flight.rec"
        simulation = Simulation("erle_copter", seed=1)
        Recorder(simulation, path)
        vehicle = Client(simulation)
        vehicle.wait_ready()
        vehicle.take_off(10)
        vehicle.goto(north=30, east=10)
        vehicle.return_to_launch()
        simulation.close()
        return [flight.read(path)]


def calm_and_wind() -> list[flight.Flight]:
    """A mission of the regression suite, and the same in wind."""
    return [flight.read(GOLDEN / f"copter-circles{name}.rec") for name in ("", "-wind")]


SCENES: dict[str, Callable[[], list[flight.Flight]]] = {"first-flight": first_flight, "calm-and-wind": calm_and_wind}


def make(folder: Path) -> None:
    """Write all scenes as NAME.html into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, fly in SCENES.items():
        page = FlightPage(*together(fly(), "armed"))
        try:
            page.save(folder / f"{name}.html", MOMENTS)
        finally:
            page.close()


def embed(page: str, text: str) -> str:
    """The text of a page with its scenes in frames.

    Args:
        page: its name, such as "tutorials/first-flight".
        text: Markdown.

    Raises:
        KeyError: there is no such scene.
    """
    up = "../" * page.count("/")

    def frame(mark: re.Match[str]) -> str:
        title = SCENES[mark[1]].__doc__
        return (
            f'```{{raw}} html\n<iframe src="{up}_static/scenes/{mark[1]}.html" title="{title}" loading="lazy" '
            'style="width:100%;height:420px;border:1px solid #8884"></iframe>\n```'
        )

    return MARK.sub(frame, text)
