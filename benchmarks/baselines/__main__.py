# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.baselines [NAME...]``: trains and evaluates what is missing, then writes docs/baselines.md.

Results are kept in benchmarks/results, a line each; what is up to date there is not made again, so the command can be
stopped (Ctrl-C, --budget) and started again, also on another day or machine.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from sitl.agents.deep.library import require
from sitl.agents.errors import check_names
from sitl.agents.runs.backends import Workers
from sitl.errors import SitlError

from . import defaults, entries, page
from .campaign import Campaign, campaign
from .conditions import ARDUPILOT, PX4, Program
from .records import FOLDER
from .running import duration, run

RUNS = Path("runs/baselines")
SEEDS = 5


def parser() -> argparse.ArgumentParser:
    """Of the command."""
    made = argparse.ArgumentParser(prog="python -m benchmarks.baselines", description=__doc__)
    add = made.add_argument
    add("names", nargs="*", metavar="NAME", help="baselines (docs/baselines.md); default: all")
    add("--plan", action="store_true", help="list what is missing, with estimated times, and do nothing")
    add("--seeds", type=int, default=SEEDS, metavar="N", help=f"trainings of each (default {SEEDS})")
    add("--jobs", type=int, default=1, metavar="N", help="processes (default 1); torch has one thread in each")
    add(
        "--budget",
        type=float,
        default=float("inf"),
        metavar="MINUTES",
        help="stop after so long; the next call goes on",
    )
    add("--ardupilot", type=Path, action="append", default=[], metavar="PROGRAM",
        help="a real arducopter or ardurover, to evaluate with; can be given twice")  # fmt: skip
    add("--px4", type=Path, metavar="PROGRAM", help="a real px4, to evaluate policies of copters with")
    add("--only-autopilots", action="store_true",
        help="evaluate trained policies with the programs of --ardupilot and --px4, and do nothing else")  # fmt: skip
    add("--defaults", action="store_true", help="instead: curves of PPO, SAC and DQN with default settings")
    add("--ship", action="store_true", help="make the median training of each the policy that the package contains")
    add("--prune", action="store_true", help="delete results that are out of date")
    add("--results", type=Path, default=FOLDER, metavar="DIR", help="default: benchmarks/results")
    add("--runs", type=Path, default=RUNS, metavar="DIR", help=f"runs and trained policies (default {RUNS})")
    add("--steps", type=int, metavar="N", help="of each training, in place of the recipe's: for trials")
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    options = parser().parse_args(arguments)
    try:
        return _main(options)
    except SitlError as error:
        print(error, file=sys.stderr)
        return 1


def _main(options: argparse.Namespace) -> int:
    names = entries.names()
    check_names(options.names, names, "baseline {!r}")
    programs = [Program(ARDUPILOT, path.resolve()) for path in options.ardupilot]
    programs += [Program(PX4, options.px4.resolve())] if options.px4 else []
    chosen = options.names or names
    found = campaign(
        chosen, options.results, options.runs, options.seeds, tuple(programs), options.steps, options.only_autopilots
    )
    _say(f"playing {len(chosen)} environments, to see whether they have changed")
    for name in found.references.check({entry.plain: entry.playing() for entry in found.chosen}):
        _say(f"{name}: its environment has changed; earlier results are out of date")
    if options.prune:
        wanted = (*found.wanted_keys(), *(curve.key for curve in defaults.wanted(found)))
        _say(f"{found.records.prune(chosen, wanted)} results were out of date, and are deleted")
    if options.plan:
        _plan(found, options.jobs)
        return 0
    if not options.only_autopilots:
        require()
    do = defaults.run if options.defaults else run
    done = do(found, Workers(options.jobs), time.time() + 60.0 * options.budget, _say)
    if options.steps is None and options.ship:
        page.ship(found, _say)
    if options.steps is None and options.results == FOLDER:  # the page shows all baselines, whichever were chosen
        page.write(campaign(names, FOLDER, options.runs, max(options.seeds, SEEDS)))
    _say("all is done" if done else "not all is done; the same command goes on")
    return 0


def _plan(found: Campaign, jobs: int) -> None:
    curves = len(defaults.missing(found))
    most = duration(curves * defaults.LIMIT_S)
    _say(f"== default settings (--defaults): {curves} curves, at most {most} of processor time")
    stages = found.stages()
    for title, some in stages:
        _say(f"== {title}: {duration(found.left([(title, some)]))} of processor time")
        for job in some:
            training, playing = found.seconds(job)
            parts = [f"training {duration(training)}"] if training else []
            parts.append(f"{len(job.whats)} evaluations {duration(playing)}")
            _say(f"   {job.name}: {', '.join(parts)}")
    total = found.left(stages)
    _say(f"all: {duration(total)} of processor time, about {duration(total / jobs)} with --jobs {jobs}")


def _say(text: str) -> None:
    print(time.strftime("%H:%M:%S "), text, sep="", flush=True)


if __name__ == "__main__":
    sys.exit(main())
