# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission compare``: whether a flight is as golden."""

from __future__ import annotations

import argparse
from pathlib import Path

from sitl.cli.options import open_folder
from sitl.cli.progress import CompileProgress
from sitl.errors import OptionError
from sitl.recording.entries import RecordingError


def add_parser(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = actions.add_parser("compare", help="compare two flights (.rec, .tlog, .bin or .log)")
    parser.add_argument("golden", type=Path, metavar="GOLDEN", help="the golden flight")
    parser.add_argument("new", type=Path, metavar="NEW", help="the flight to compare with it")
    parser.add_argument(
        "--tolerance",
        metavar="NAME|DISTANCE|FILE",
        help='exact, same, alike, a distance with its unit ("0.5 m"), or a .toml file (default, if seed, vehicle and '
        "world are equal: exact on native physics, same on another engine; else alike)",
    )
    parser.add_argument("--report", type=Path, metavar="DIR", help="write report.html and junit.xml to this folder")
    parser.add_argument("--all", action="store_true", help="print every metric, not only those beyond their limits")
    parser.add_argument("--system", type=int, metavar="N", help="system id of the vehicle in a .tlog that has several")
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Compare; 0 when it flies like golden, 1 when it does not."""
    from ..comparison import report
    from ..comparison.compare import compare
    from ..comparison.flight import read

    if options.report is not None:
        open_folder(options.report, "--report")
    try:
        with CompileProgress() as progress:
            golden, new = (read(path, options.system, progress) for path in (options.golden, options.new))
    except RecordingError as error:
        raise OptionError(str(error)) from None
    comparison = compare(golden, new, options.tolerance)
    written = report.report_write(comparison, options.report) if options.report is not None else None
    print("\n".join(report.lines(comparison, options.all)))
    if written is not None:
        print(f"report: {written}")
    return 0 if comparison.ok else 1
