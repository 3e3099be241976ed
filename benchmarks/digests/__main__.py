# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.digests``: what a tree flies as digests, and whether two trees fly the same.

``record`` and ``check`` do it with the digests that the repository keeps: does this machine fly the same as others?
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import multiprocessing
import os
import sys
import time
import traceback
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from . import company, kept, robots, tree
from . import flights as vehicles
from .compare import Comparison, compare
from .leaves import leaves
from .pilot import Pilot

QUICK = (
    "native/power_on/*", "native/log/*", "native/mission/copter/spline_figure", "native/mission/rover/figure_eight",
    "native/mission/*/square-truth", "native/copter/LOITER-erle_copter", "native/copter/STABILIZE-ardupilot_quad",
    "native/copter/failsafe-gps", "native/copter/failsafe-rc", "native/copter/on_ground-erle_copter",
    "native/*/world", "native/copter/guided-*", "native/*/by_dice-*-11", "native/rover/guided-erle_rover",
    "native/rover/guided-skid_rover", "native/rover/ACRO-erle_rover", "native/rover/on_ground-erle_rover",
    "native/rover/failsafe-rc-smart_rtl", "jsbsim/copter/guided", "pybullet/rover/guided", "turtlebot/maze",
    "env/Gazebo*", "env/navigate-turtlebot-goal", "native/*/faults", "fleet/erle_copter", "swarm/formation",
    "policy/copter-gates", "policy/rover-parking", "env/CopterForest", "env/RoverLabyrinth",
)  # fmt: skip
"""Patterns of the flights that are enough after each edit."""


OTHER_ENGINES = ("jsbsim", "pybullet")
"""Their flights are not kept: what they compute depends on the processor and on their libraries."""


def flights() -> dict[str, Callable[[], Any]]:
    """Every flight by its name."""
    return {**vehicles.flights(), **robots.flights(), **company.flights()}


def chosen(patterns: str | None, quick: bool) -> list[str]:
    """Names of the flights that are asked for.

    Args:
        patterns: shell patterns or beginnings of names, separated by commas; None: all.
        quick: only those that are enough after each edit.
    """
    wanted = [f"{each}*" for each in patterns.split(",")] if patterns is not None else ["*"]
    return [
        name
        for name in flights()
        if any(fnmatch.fnmatch(name, each) for each in wanted)
        and (not quick or any(fnmatch.fnmatch(name, each) for each in QUICK))
    ]


def is_kept(name: str) -> bool:
    """Whether the repository keeps digests of a flight."""
    return not any(engine in name for engine in OTHER_ENGINES)


def fly(name: str) -> tuple[float, dict[str, Any]]:
    """Seconds of wall time, and the digests of one flight; with "error" when it cannot be flown, and "missing" when it
    needs what is not installed here."""
    start = time.perf_counter()
    try:
        digests: dict[str, Any] = flights()[name]().result()
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        digests = {"error": f"{type(error).__name__}: {error} ({Path(where.filename).name}:{where.lineno})"}
        if type(error).__name__ == "MissingExtra":  # of whichever tree is flown
            digests["missing"] = str(error)
    return time.perf_counter() - start, digests


def fly_all(names: list[str], jobs: int) -> dict[str, Any]:
    """Fly; the digests of each flight."""
    flown: dict[str, Any] = {}
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("fork")) as pool:
        for name, (seconds, flown[name]) in zip(names, pool.map(fly, names)):
            print(f"{seconds:6.2f} s  {name}  {flown[name].get('error', '')}", flush=True)
    return flown


def with_kept_digests(names: list[str]) -> list[str]:
    """Those of some flights whose digests the repository keeps; says which are left out."""
    left_out = [name for name in names if not is_kept(name)]
    if left_out:
        print(f"left out, because no digests of other engines are kept: {', '.join(left_out)}", file=sys.stderr)
    return [name for name in names if is_kept(name)]


def record(path: Path, names: list[str], jobs: int) -> int:
    """Fly, and put the digests into the file that the repository keeps; returns how many could not be flown."""
    flown = fly_all(with_kept_digests(names), jobs)
    before = kept.load(path) if path.exists() else {}
    there = {name: flight for name, flight in before.items() if name in flights()}
    now = {name: kept.keep(digests) for name, digests in flown.items() if "error" not in digests}
    kept.write(path, there | now)
    changed = [name for name in now if before.get(name) != now[name]]
    print(f"{path}: {len(there | now)} flights, {len(changed)} of them new or changed")
    return len(flown) - len(now)


def check(path: Path, names: list[str], jobs: int) -> list[str]:
    """Fly; what differs from the digests that the repository keeps, in words. Flights that need what is not installed
    here are left out, and named."""
    flown = fly_all(with_kept_digests(names), jobs)
    for name in [name for name, each in flown.items() if "missing" in each]:
        print(f"left out: {name}: {flown.pop(name)['missing']}", file=sys.stderr)
    found = [f"{name}: it cannot be flown: {each['error']}" for name, each in flown.items() if "error" in each]
    now = {name: kept.keep(each) for name, each in flown.items() if "error" not in each}
    found += kept.differences(kept.load(path), now)
    print(*found, sep="\n")
    print(f"{len(found)} of {len(flown)} flights differ" if found else f"same: {len(flown)} flights")
    return found


def write(path: Path, names: list[str], jobs: int) -> int:
    """Fly, and write the digests; returns how many could not be flown."""
    flown = fly_all(names, jobs)
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(digests)}" for name, digests in flown.items())
    path.write_text(f"{{{lines}}}\n")
    return sum("error" in digests for digests in flown.values())


def read_names(path: Path | None) -> dict[str, str]:
    """Renamed leaves: a file of lines ``old=new``; # begins a comment."""
    names: dict[str, str] = {}
    for line in path.read_text().splitlines() if path is not None else ():
        old, equals, new = (part.strip() for part in line.partition("#")[0].partition("="))
        if old and not equals:
            raise SystemExit(f"{path}: {line!r} is not of the form old=new")
        if old:
            names[old] = new
    return names


def tell(found: Comparison, every: bool) -> None:
    """Print a comparison."""
    for name, differences in found.differing.items():
        print(f"DIFFERS  {name}", *differences, sep="\n         ")
    for title, names in (
        ("flights only in the first", found.only_first),
        ("flights only in the second", found.only_second),
        ("leaves only in the first", sorted(found.leaves_only_first)),
        ("leaves only in the second", sorted(found.leaves_only_second)),
    ):
        if names:
            shown = names if every else names[:12]
            print(f"{title} ({len(names)}): {', '.join(shown)}{' ...' if len(shown) < len(names) else ''}")
    if found.differing:
        print(f"{len(found.differing)} of {len(found.same) + len(found.differing)} flights differ")
    else:
        print(f"same: {len(found.same)} flights")


class Reached(Exception):
    """The flight has come to the time that is looked at."""


def show(name: str, until_s: float) -> None:
    """Fly until a simulated time, and print every leaf there: for a diff between two trees."""

    def look(pilot: Pilot, now_us: int) -> None:
        if now_us >= until_s * 1e6:
            dtype, record = tree.record(pilot.simulation)
            for leaf in leaves(dtype):
                print(leaf.path, *(repr(number) for number in leaf.value(record).tolist()))
            raise Reached

    Pilot.on_step = look
    try:
        flights()[name]()
    except Reached:
        return
    raise SystemExit(f"{name} is no flight with a record, or ends before {until_s} s")


def main(arguments: list[str] | None = None) -> int:
    """The command line; 1 when flights differ or could not be flown, 2 when there is nothing to do."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.digests", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    writing = commands.add_parser("write", help="fly, and write digests to a file")
    writing.add_argument("file", type=Path)
    writing.add_argument("--jobs", type=int, default=1, metavar="N", help="processes")
    comparing = commands.add_parser("compare", help="compare two files; exit code 1 when flights differ")
    comparing.add_argument("first", type=Path)
    comparing.add_argument("second", type=Path)
    comparing.add_argument("--renamed", type=Path, metavar="FILE", help="lines old=new: leaves or their parents")
    comparing.add_argument("--all", action="store_true", help="name every leaf that only one has")
    listing = commands.add_parser("list", help="names of the flights")
    recording = commands.add_parser("record", help="fly, and write the digests that the repository keeps")
    checking = commands.add_parser("check", help="fly, and compare with the digests that the repository keeps")
    for each in (recording, checking):
        each.add_argument("--jobs", type=int, default=1, metavar="N", help="processes")
        each.add_argument("--file", type=Path, default=None, help=f"default: {kept.FILE} of the tree")
    for each in (writing, listing, recording, checking):
        each.add_argument("--only", metavar="NAMES", help="beginnings of names or patterns, separated by commas")
        each.add_argument("--quick", action="store_true", help="those that are enough after each edit")
    showing = commands.add_parser("show", help="print every leaf of the record at a time of a flight")
    showing.add_argument("name")
    showing.add_argument("seconds", type=float, help="simulated")
    options = parser.parse_args(arguments)
    if options.command == "compare":
        first, second = (json.loads(path.read_text()) for path in (options.first, options.second))
        found = compare(first, second, read_names(options.renamed))
        tell(found, options.all)
        return 1 if found.differing else 0 if found.same else 2
    if options.command == "show":
        if options.name not in flights():
            parser.error(f"no flight {options.name!r}: see list")
        show(options.name, options.seconds)
        return 0
    names = chosen(options.only, options.quick)
    if not names:
        parser.error(f"no flight has a name like {options.only!r}: see list")
    if options.command == "list":
        print(*names, sep="\n")
        return 0
    if options.command in ("record", "check"):
        names = with_kept_digests(names)
        if not names:
            parser.error("none is left: write and compare take all flights")
    print(f"tree {tree.root()}: {len(names)} flights", file=sys.stderr)
    if options.command in ("record", "check"):
        path = options.file or tree.root() / kept.FILE
        if options.command == "record":
            return 1 if record(path, names, options.jobs) else 0
        if not path.exists():
            parser.error(f"there is no {path}; {kept.RENEW} makes it")
        return 1 if check(path, names, options.jobs) else 0
    return 1 if write(options.file, names, options.jobs) else 0


if __name__ == "__main__":
    os.environ["MAVLINK20"] = "1"
    sys.exit(main())
