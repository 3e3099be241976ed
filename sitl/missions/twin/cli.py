# SPDX-License-Identifier: BSD-3-Clause
"""``sitl twin``: a log's flight again, on our autopilot and physics, beside the log; and with something changed."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from sitl.cli.fault_options import add_fail_option, vehicle_faults
from sitl.cli.options import open_folder
from sitl.cli.output import add_json_option, print_json
from sitl.cli.progress import CompileProgress
from sitl.errors import OptionError
from sitl.physics.engines import NATIVE
from sitl.vehicle.faults import Failure


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("twin")
    parser.add_argument("log", type=Path, metavar="LOG", help="DataFlash log (.bin, .log) of ArduPilot or gym-sitl")
    parser.add_argument("--frame", required=True, metavar="NAME|FILE", help="airframe of the twin (sitl help vehicles)")
    parser.add_argument("--flight", type=int, metavar="N", help="which flight of the log (default: the longest)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of the twin's sensor noise (default 0)")
    parser.add_argument("--physics", default=NATIVE, metavar="NAME", help=f"physics engine (default {NATIVE})")
    parser.add_argument(
        "--logged-wind",
        type=wind,
        metavar="SPEED[@FROM]",
        help="wind in the log's flight [m/s, deg] (default: as its estimator knew it)",
    )
    parser.add_argument("--no-segments", action="store_true", help="no open segments: the whole flight only")
    parser.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="exit code 1 when a metric is beyond it: height.rms=0.5, segments.roll_rate.vaf=80 (repeatable)",
    )
    what_if = parser.add_argument_group("what if: the twin is flown once more, with")
    what_if.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="another parameter (repeatable)"
    )
    what_if.add_argument("--wind", type=wind, metavar="SPEED[@FROM]", help="other wind [m/s, deg it comes from]")
    what_if.add_argument("--mass", default="", metavar="KG", help="another mass, or a payload: +0.5")
    add_fail_option(what_if)  # type: ignore[arg-type]
    parser.add_argument("--report", type=Path, metavar="FILE.html", help="write a report: one file with all plots")
    parser.add_argument("--log-dir", type=Path, metavar="DIR", help="keep the twins' own logs (.bin) in this folder")
    add_json_option(parser, "all metrics, notes and findings")
    parser.set_defaults(function=run)


def wind(text: str) -> tuple[float, float]:
    """``SPEED`` or ``SPEED@FROM``: m/s, and where it comes from in degrees (180)."""
    speed, _, direction = text.partition("@")
    try:
        found = (float(speed), float(direction) if direction else 180.0)
    except ValueError:
        found = (math.nan, math.nan)
    if not (0.0 <= found[0] <= 50.0 and 0.0 <= found[1] <= 360.0):
        raise argparse.ArgumentTypeError(f"{text!r} is not SPEED[@FROM]: 0 to 50 m/s, 0 to 360 degrees, as in 8@270")
    return found


def _settings(texts: list[str]) -> dict[str, float]:
    found = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            found[name.strip().upper()] = float(value)
        except ValueError:
            raise OptionError(f"--set {text!r} is not NAME=VALUE, as in ATC_RAT_RLL_P=0.2") from None
    return found


def run(options: argparse.Namespace) -> int:
    """Fly the twin; 1 when a limit is not kept."""
    from . import limits, report, twin
    from .log_flight import Change

    wanted = dict(limits.parse(text) for text in options.limit)
    faults = tuple(str(Failure.of(text)) for text in vehicle_faults(options))
    change = Change(_settings(options.set), options.wind, faults, options.mass)
    if options.report is not None and options.report.suffix.lower() not in (".html", ".htm"):
        raise OptionError(f"--report {str(options.report)!r} does not end in .html")
    keep = open_folder(options.log_dir) if options.log_dir is not None else None
    with CompileProgress() as progress:
        found = twin.fly(
            options.log, options.frame, flight=options.flight, seed=options.seed, physics=options.physics,
            change=change, wind=options.logged_wind, segments=not options.no_segments, progress=progress, keep=keep,
        )  # fmt: skip
    verdicts = limits.judge(found.metrics(), wanted)
    if options.report is not None:
        report.write(found, verdicts, options.report)
    ok = all(verdict.ok for verdict in verdicts)
    if options.json:
        beyond = [verdict.words for verdict in verdicts if not verdict.ok]
        print_json({**found.to_json(), "ok": ok, "beyond_limits": beyond})
    else:
        print("\n".join(report.lines(found, verdicts)))
        if options.report is not None:
            print(f"report: {options.report}")
    return 0 if ok else 1
