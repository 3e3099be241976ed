# SPDX-License-Identifier: BSD-3-Clause
"""``sitl identify``: an airframe's file from the logs of a vehicle; ``--plan``: what to fly so that logs show more."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path

from ..errors import MissingExtra, OptionError


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("identify")
    parser.add_argument(
        "logs", nargs="*", type=Path, metavar="LOG", help="logs of one copter (.bin, .tlog) or rover (.bin)"
    )
    parser.add_argument("--out", type=Path, metavar="FILE.toml", help="write the airframe that --frame takes")
    parser.add_argument("--mass", type=float, metavar="KG", help="mass of the vehicle: logs alone tell ratios")
    parser.add_argument(
        "--above",
        type=float,
        metavar="M",
        help="height over the ground from which on a copter's flight counts (2); less for a small one that flew low",
    )
    parser.add_argument(
        "--plan", type=Path, metavar="FILE.waypoints", help="write a mission that makes the properties observable"
    )
    parser.add_argument("--home", metavar="LAT,LON", help="where the mission of --plan takes off [deg] (needed)")
    parser.add_argument("--vehicle", choices=("copter", "rover"), default="copter", help="that drives --plan (copter)")
    parser.add_argument(
        "--speed",
        type=float,
        metavar="M/S",
        help="of the fastest legs of a rover's --plan (1.5), whose size follows from it",
    )
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Print what the logs show; write the airframe or the plan."""
    if options.plan is None and not options.logs:
        raise OptionError("LOG is missing: a .bin or .tlog log, or --plan FILE for what to fly")
    if options.out is not None and options.out.suffix != ".toml":
        raise OptionError(f"--out {str(options.out)!r} does not end in .toml, by which --frame tells such files")
    if options.plan is not None:
        from .flight_plan import advice, write

        speed = _speed(options.vehicle, options.speed)
        write(options.plan, _home(options.home), options.vehicle, speed)
        print(advice(options.vehicle, speed))
        print(f"mission: {options.plan}")
    if options.logs:
        _identify(options.logs, options.mass, options.out, options.above)
    return 0


def _speed(vehicle: str, speed: float | None) -> float:
    if speed is not None and vehicle != "rover":
        raise OptionError(f"--speed {speed:g} is of a rover's plan: add --vehicle rover")
    found = 1.5 if speed is None else speed
    if not 0.1 <= found <= 30.0:
        raise OptionError(f"--speed {found:g} m/s is outside 0.1 .. 30")
    return found


def _home(text: str | None) -> tuple[float, float]:
    try:
        latitude, longitude = (float(word) for word in (text or "").split(","))
    except ValueError:
        latitude = longitude = math.nan
    if not (abs(latitude) < 89.0 and abs(longitude) <= 180.0):
        raise OptionError(f"--home {text!r} is not LAT,LON in degrees, as 47.397,8.545: the mission lies around it")
    return latitude, longitude


def _identify(logs: Sequence[Path], mass: float | None, out: Path | None, above: float | None) -> None:
    try:
        from .identification import identify
        from .log_streams import ABOVE_M
        from .required_messages import HOW
    except ModuleNotFoundError as error:
        if error.name != "scipy":
            raise
        raise MissingExtra("sitl identify needs scipy: pip install 'gym-sitl[identify]'") from None
    from tqdm import tqdm

    with tqdm(total=0, unit="B", unit_scale=True, leave=False, file=sys.stderr, disable=not sys.stderr.isatty()) as bar:

        def progress(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        def begins(what: str) -> None:
            bar.bar_format = "{desc} ({elapsed})"
            bar.set_description_str(f"properties: {what}")

        found = identify(logs, mass, progress, begins, ABOVE_M if above is None else above)
    print(found.table())
    for note in (note for log in found.logs for note in log.notes):
        print(f"note: {note}")
    for doubt in found.doubts:
        print(f"note: {doubt}")
    if any(log.is_telemetry for log in found.logs):
        print(f"note: {HOW}")
    if out is not None:
        found.write(out)
        print(f"airframe: {out}")
