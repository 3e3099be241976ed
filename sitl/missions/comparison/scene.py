# SPDX-License-Identifier: BSD-3-Clause
"""Two compared flights as one file with the scene of both, which a browser opens from disk (docs/view.md)."""

from __future__ import annotations

from pathlib import Path

from sitl.view import page_library
from sitl.view.flights import of_track

from .compare import Comparison

NAME = "flights.html"
_CURVES = ("position", "cross_track")
_FRAMES = 150
"""Moments in the file, at most."""


def write(comparison: Comparison, folder: Path) -> Path | None:
    """Write the file into a folder; gives its path, None where the extra ``view`` is not installed.

    Raises:
        SitlError: it cannot be written.
    """
    if not page_library.is_installed():
        return None
    from sitl.view.flight_page import FlightPage

    pair, differences = comparison.pair, comparison.differences
    flights = [of_track("golden", pair.golden), of_track("new", pair.new)]
    curves = {f"{differences[name].title} [m]": (differences[name].t, differences[name].size) for name in _CURVES}
    page = FlightPage(flights, curves)
    try:
        path = folder / NAME
        page.save(path, _FRAMES)
    finally:
        page.close()
    return path
