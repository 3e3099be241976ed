# SPDX-License-Identifier: BSD-3-Clause
"""``sitl rehearse``: what was learnt in one simulation is tried in others that it has not seen."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tqdm import tqdm

from sitl.core import code_in_files
from sitl.envs.robots.boots import check_boots

from ..errors import AgentError
from ..rehearsal import plan as plans
from ..rehearsal.airframe_plan import airframe_of, airframe_plan
from ..rehearsal.change import Change
from ..rehearsal.plan import Plan
from ..rehearsal.policies import group_of
from ..rehearsal.rehearse import EPISODES, Rehearsed, rehearse, trials_of
from ..rehearsal.report import write_report
from ..rehearsal.trial import check_kind, robot_name
from ..report.group import Group, unique_names
from ..runs.backends import Workers
from ..runs.config import RunConfig
from ..runs.evaluation_plan import EvaluationPlan
from ..runs.files import make_folder
from .agent_options import add_jobs, add_said_again, check_report_libraries, positive, whole, workers


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    shipped = ", ".join(plans.names())
    parser = commands.add_parser(
        "rehearse",
        description="Tests the robustness of trained policies: evaluates them in their own environment and under "
        "changes (other world, physics, vehicle, sensor noise, latency), and reports the share of the reward "
        "that is kept.",
    )
    parser.add_argument(
        "runs", nargs="+", type=Path, metavar="RUN",
        help="run folders, folders of several seeds, policy files (.npz), or names of baselines (sitl help baselines)",
    )  # fmt: skip
    parser.add_argument(
        "--plan", metavar="NAME", help=f"list of changes: a .toml file, or {shipped} (default: that of the robot)"
    )
    parser.add_argument(
        "--airframe",
        metavar="FILE",
        help="rehearse on the vehicle of an airframe's file with intervals, as sitl identify writes it: as it is, at "
        "both ends of each interval, and drawn within all; with --plan besides that plan's changes",
    )
    parser.add_argument("--only", action="append", metavar="CHANGE", help="a change or a group of changes, by name")
    parser.add_argument(
        "--episodes",
        type=positive,
        metavar="N",
        help=f"episodes of each change and run (default: {EPISODES}, or the run's)",
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="seed of the episodes (default 0)")
    parser.add_argument(
        "--jitter", type=float, metavar="X", help="move start poses by up to X m and X rad (default: of the run)"
    )
    parser.add_argument(
        "--boots", type=positive, metavar="N",
        help="begin each episode of a vehicle with an autopilot with one of N prepared boots (default: of the run's "
        "environment; with 1 the intervals do not hold how much boots differ)",
    )  # fmt: skip
    add_said_again(parser)
    add_jobs(parser)
    parser.add_argument(
        "--out", type=Path, default=Path("reports/rehearsal"), metavar="DIR", help="default: reports/rehearsal"
    )
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Run the command."""
    check_report_libraries()
    pool = workers(options)
    if options.airframe is not None:  # what was trained on it names it, too
        code_in_files.allow_options({"frame": options.airframe})
    groups = [group_of(path, name) for path, name in zip(options.runs, unique_names(options.runs))]
    environments = {group.config.env for group in groups}
    if len(environments) > 1:
        raise AgentError(f"runs in {' and '.join(sorted(environments))} cannot be held side by side; give one of them")
    config = groups[0].config
    plan = _plan(options, config)
    changes = plan.chosen(options.only or ())
    EvaluationPlan().changed(jitter=options.jitter)  # refuses one that cannot be
    if options.boots is not None:
        check_boots(options.boots)
    make_folder(options.out)  # before all is played, see that it can be written
    found = with_bar(groups, changes, options.episodes, options.seed, options.jitter, pool, options.boots)
    if found is None:
        print("interrupted; nothing was written", file=sys.stderr)
        return 130
    refused = {change.name: None for one in found for change, tried in zip(one.changes, one.tried) if tried.refused}
    if refused:
        print(f"not played, for reasons that the report has: {', '.join(refused)}", file=sys.stderr)
    print(write_report({config.env: found}, options.out, options.seed))
    return 0


def _plan(options: argparse.Namespace, config: RunConfig) -> Plan:
    if options.airframe is None:
        return plans.load(options.plan) if options.plan else plans.plan_for(robot_name(config))
    of_airframe = airframe_plan(options.airframe)
    check_kind(config, airframe_of(options.airframe))
    if not options.plan:
        return of_airframe
    given = plans.load(options.plan)
    return replace(of_airframe, changes=(*of_airframe.changes, *given.changes))


def with_bar(
    groups: Sequence[Group],
    changes: Sequence[Change],
    episodes: int | None,
    seed: int,
    jitter: float | None,
    pool: Workers,
    boots: int | None = None,
) -> list[Rehearsed] | None:
    """``rehearse`` with a progress bar of all episodes."""
    total = sum(trial.episodes for group in groups for trial in trials_of(group.runs, changes, episodes, seed))
    with tqdm(total=total, unit="episode", file=sys.stderr, disable=None, smoothing=0.1) as bar:

        def on_progress(index: int, count: Any) -> None:
            bar.update(count)

        return rehearse(groups, changes, episodes, seed, jitter, on_progress, pool, boots)
