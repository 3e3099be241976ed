# SPDX-License-Identifier: BSD-3-Clause
"""What the commands that read mission files have in common."""

from __future__ import annotations

import argparse
import sys

from ..files import MissionFile, MissionFileError, joined, load


def add_file_options(parser: argparse.ArgumentParser) -> None:
    """Declare what is read beside a mission, and what a KML does not say."""
    parser.add_argument("--altitude", type=float, metavar="M", help="height above home of a KML's path")
    parser.add_argument("--fence", metavar="FILE", help="geofence from another file (.fen, .poly, .kml ...)")
    parser.add_argument("--rally", metavar="FILE", help="rally points from another file")


def load_all(path: str, options: argparse.Namespace) -> MissionFile:
    """A file with the fence and the rally points of the others that the options name.

    Raises:
        MissionFileError: one cannot be read, or has nothing of what it is named for.
    """
    others = []
    for option, what in (("fence", "fence_items"), ("rally", "rally_items")):
        name = getattr(options, option)
        if name is None:
            continue
        found = load(name)
        if not getattr(found, what):
            raise MissionFileError(f"--{option} {name}: there is none in it")
        others.append(found)
    return joined(load(path, options.altitude), *others)


def say_notes(file: MissionFile) -> None:
    """Say what the user should know of how a file was read."""
    for note in file.notes:
        print(f"{file.name}: {note}", file=sys.stderr)
