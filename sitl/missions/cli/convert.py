# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission convert``: from the formats of mission files that are read to those that are written."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from sitl.errors import OptionError
from sitl.vehicle.kinds import DEFAULT, KINDS

from ..files import as_flight, save, straightened
from ..files.store import READ_TEXT
from .mission_options import add_file_options, load_all, say_notes


def add_parser(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = actions.add_parser("convert", help="convert to .plan or .waypoints")
    parser.add_argument("source", metavar="FROM", help=READ_TEXT)
    parser.add_argument("target", metavar="TO", help="the suffix sets the format")
    parser.add_argument("--vehicle", choices=sorted(KINDS), help="vehicle type of a .plan")
    parser.add_argument(
        "--expand", action="store_true", help="write surveys, corridors, structures and splines as waypoints"
    )
    add_file_options(parser)
    parser.add_argument("--force", action="store_true", help="overwrite TO")
    parser.set_defaults(function=convert)


def convert(options: argparse.Namespace) -> int:
    """Read, write, say what was left out."""
    file = load_all(options.source, options)
    target = Path(options.target)
    if target.exists() and not options.force:
        raise OptionError(f"{target} is there already; --force replaces it")
    kind = options.vehicle or (file.kind if file.vehicle_type is None else None)
    if KINDS[kind or DEFAULT].flies:
        file = as_flight(file)
    if kind is not None:
        file = replace(file, vehicle_type=KINDS[kind].mav_type)
    if options.expand:
        file = straightened(file).simple()
    save(file, target)
    if file.mission.items and file.has_fence_or_rally and target.suffix.lower() != ".plan":
        print(f"{target}: geofence and rally points are left out: the format has no place for them", file=sys.stderr)
    say_notes(file)
    if file.mission.items:
        print(f"{target}: {max(len(file.mission) - 1, 0)} items")
    else:
        areas = len(file.circles) + len(file.polygons)
        print(f"{target}: no mission; geofence of {areas} areas, {len(file.rally)} rally points")
    return 0
