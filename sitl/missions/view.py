# SPDX-License-Identifier: BSD-3-Clause
"""``sitl view``: flights that were kept, on a page in the browser or in a file."""

from __future__ import annotations

import argparse
import threading
from pathlib import Path

from sitl.cli.options import port
from sitl.cli.progress import CompileProgress
from sitl.cli.view_options import open_browser
from sitl.errors import OptionError
from sitl.recording.entries import RecordingError
from sitl.run.stop_signals import StopSignals
from sitl.view import page_library
from sitl.view.flight_page import FlightPage, Series
from sitl.view.flights import Flight, of_track

from .comparison import alignment, flight

_CURVES = ("position", "cross_track")
"""Differences that are drawn of two flights: at the same time, and from the other's path."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("view")
    parser.add_argument(
        "flights",
        nargs="+",
        type=Path,
        metavar="FLIGHT",
        help=".tlog, .bin, .log (DataFlash as text) or .rec; several flights are aligned in time",
    )
    parser.add_argument(
        "--align",
        choices=("auto", "AUTO", "armed", "start"),
        default="auto",
        help="event at which the flights are aligned (auto: one flight alone stays as it was logged)",
    )
    parser.add_argument(
        "--frame",
        metavar="NAME",
        help="airframe to draw (default: that of the file, or the default of its vehicle type)",
    )
    parser.add_argument("--system", type=int, metavar="N", help="system id of the vehicle in a .tlog that has several")
    parser.add_argument(
        "--save", type=Path, metavar="FILE.html", help="write one .html file that opens without a server, and exit"
    )
    parser.add_argument(
        "--view-port", type=port, default=0, metavar="PORT", help="port of the page (default: a free one)"
    )
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Show the flights until Ctrl-C, or write the file."""
    page_library.require()
    try:
        with CompileProgress() as progress:
            found = [flight.read(path, options.system, progress) for path in options.flights]
        for each in found:
            for note in each.notes:
                print(f"{each.name}: {note}")
    except RecordingError as error:
        raise OptionError(str(error)) from None
    flights, curves = together(found, options.align, options.frame)
    page = FlightPage(flights, curves, options.view_port)
    try:
        if options.save is not None:
            page.save(options.save)
            print(f"page: {options.save}")
            return 0
        stopped = threading.Event()
        with StopSignals(then=stopped.set) as signals:
            signals.catch()
            print(f"page: {page.address}", flush=True)
            open_browser(page.address)
            stopped.wait()
    finally:
        page.close()
    return 0


def together(found: list[flight.Flight], align: str = "auto", frame: str | None = None) -> tuple[list[Flight], Series]:
    """Flights with a common clock, and how far the second is from the first.

    Args:
        found: as they were read; the first is the one that others are aligned with.
        align: what they have in common, as a tolerance has it; one flight begins there, with "auto" where its log does.
        frame: airframe that is drawn; None: the usual one.

    Raises:
        OptionError: a flight has no samples.
        sitl.missions.comparison.alignment.AlignmentError: they have nothing in common, or no such moment.
    """
    names = [Path(each.name).stem for each in found]
    if len(found) == 1:
        if len(found[0].track) < 2:
            raise OptionError(f"{found[0].name}: no samples: its estimator never had an origin")
        track = found[0].track if align == "auto" else alignment.part(found[0].track, align)
        return [of_track(names[0], track, frame)], {}
    first, *others = found
    pairs = [
        alignment.pair(first.track, each.track, align, first.coarse or each.coarse, (first.name, each.name))
        for each in others
    ]
    tracks = [pairs[0].golden, *(each.new for each in pairs)]
    measured = flight_differences(pairs[0])
    return [of_track(name, track, frame) for name, track in zip(names, tracks, strict=True)], measured


def flight_differences(pair: alignment.Pair) -> Series:
    """Curves of the distance of two flights."""
    differences = flight.measure(pair)
    return {f"{differences[name].title} [m]": (differences[name].t, differences[name].size) for name in _CURVES}
