# SPDX-License-Identifier: BSD-3-Clause
"""``sitl train``: an agent learns in an environment; its run is a folder."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from sitl.core.extras import MissingExtra

from .. import algorithms, environments
from ..errors import AgentError
from ..report import curves
from ..runs import folder as folders
from ..runs.bar import Bar
from ..runs.config import MAX_STEPS, RunConfig, versions
from ..runs.folder import RunFolder
from ..runs.sweep import Sweep, is_sweep
from ..runs.training import is_done, train_all
from .by_recipe import add_recipe, config_by_recipe, folder_name
from .by_sweep import add_sweep, runs_of_sweep, tell_sweep
from .options import add_jobs, assignment, assignments, positive, workers

RUNS = Path("runs")


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "train",
        help="let an agent learn in an environment",
        description="Trains an agent and writes a run folder: config.json, episodes.csv, the model, curve.png. "
        "Ctrl-C ends it after the episode; --resume goes on, and nothing is lost.",
    )
    parser.add_argument("env", nargs="?", metavar="ENV", help="id, as GazeboCircuit2TurtlebotLIDAR-v0")
    add_recipe(parser)
    parser.add_argument("--algo", choices=tuple(algorithms.ALGORITHMS), help="default: qlearn")
    parser.add_argument("--episodes", type=positive, metavar="N", help="how many; default: of the algorithm")
    parser.add_argument("--steps", type=positive, metavar="N", help="how many, of all episodes together")
    parser.add_argument("--max-steps", type=positive, metavar="N", help=f"of an episode (default {MAX_STEPS})")
    parser.add_argument("--seed", type=int, metavar="N", help="default 0; of the first run when there are several")
    parser.add_argument("--seeds", type=positive, default=1, metavar="N", help="how many runs, each with the next seed")
    add_jobs(parser)
    parser.add_argument(
        "--set", type=assignment, action="append", metavar="NAME=VALUE", help="a setting of the algorithm, as alpha=0.1"
    )
    parser.add_argument(
        "--option", type=assignment, action="append", metavar="NAME=VALUE", help="of the environment, as world=maze"
    )
    add_sweep(parser)
    parser.add_argument("--out", type=Path, metavar="RUN", help="folder (default: runs/ENV-ALGO, runs/RECIPE)")
    parser.add_argument(
        "--resume", nargs="?", const="", metavar="RUN", help="go on with a run: this one, or that of ENV and --out"
    )
    parser.set_defaults(function=train)


def train(options: argparse.Namespace) -> int:
    """Run the command."""
    pool = workers(options)
    path, runs = _runs(options)
    if all(is_done(run) for run in runs):
        if is_sweep(path):
            tell_sweep(path)
        print(f"{path} is done; --episodes or --steps lets it go on")
        return 0
    with Bar(runs) as bar:
        done = train_all([run.path for run in runs], pool.jobs, bar, pool.each)
        summary = f"{bar.steps:,} steps in {bar.wall_s:.1f} s: {bar.speed()}"
    for folder, group in _groups(path, runs).items():
        _draw(folder, group)
    print(summary, file=sys.stderr)
    if not done:
        print(f"interrupted; go on with: sitl train --resume {path}", file=sys.stderr)
        return 130
    if is_sweep(path):
        tell_sweep(path)
    print(path)
    return 0


def _groups(path: Path, runs: list[RunFolder]) -> dict[Path, list[RunFolder]]:
    if not is_sweep(path):
        return {path: runs}
    return {path / name: group for name, group in Sweep.load(path).groups().items()}


def _runs(options: argparse.Namespace) -> tuple[Path, list[RunFolder]]:
    """The folder, and the runs in it that shall be trained."""
    if options.resume and options.env is None and options.recipe is None:
        if options.out is not None or any(
            (options.algo, options.set, options.option, options.sweep, options.max_steps)
        ):
            raise AgentError(
                "--resume RUN goes on with a run as it is: give --episodes, --steps or --jobs, nothing else"
            )
        path = Path(options.resume)
        runs = [run for group in _groups(path, []).values() for run in group] or folders.find(path)
        for run in runs:
            run.extend(options.episodes, options.steps)
        return path, runs
    if options.env is None and options.recipe is None:
        raise AgentError("ENV is missing: the id of an environment, as GazeboCircuit2TurtlebotLIDAR-v0, or --recipe")
    configure = _config if options.recipe is None else config_by_recipe
    config = configure(options)
    path = Path(options.resume) if options.resume else options.out or RUNS / folder_name(options, config)
    if options.sweep:
        if options.out is None and not options.resume:
            path = path.with_name(f"{path.name}-sweep")
        return path, runs_of_sweep(options, path, configure, _open)
    if options.resume is None or not path.exists():  # a folder of what cannot be trained would only be in the way
        environments.try_all([config])
    if options.seeds == 1:
        return path, [_open(path, config, options)]
    seeds = range(config.seed, config.seed + options.seeds)
    return path, [_open(folders.seed_folder(path, seed), config.with_(seed=seed), options) for seed in seeds]


def _config(options: argparse.Namespace) -> RunConfig:
    algorithm = options.algo or "qlearn"
    module = algorithms.load(algorithm)
    length = {"episodes": options.episodes, "steps": options.steps}
    if options.episodes is None and options.steps is None:
        length = {"episodes": None, "steps": None, **module.LENGTH}
    return RunConfig(
        env=options.env,
        algorithm=algorithm,
        env_options=assignments(options.option),
        versions=versions(*module.LIBRARIES),
        settings=module.settings(algorithm, assignments(options.set)),
        seed=options.seed or 0,
        max_steps=options.max_steps or MAX_STEPS,
        **length,
    )


def _open(path: Path, config: RunConfig, options: argparse.Namespace) -> RunFolder:
    if options.resume is None or not folders.is_run(path):
        return RunFolder.create(path, config)
    run = RunFolder(path)
    different = run.config.differences(config)
    if different:
        raise AgentError(f"{path} was begun with other {', '.join(different)}; --resume {path} alone goes on as it was")
    run.extend(options.episodes, options.steps)
    return run


def _draw(path: Path, runs: list[RunFolder]) -> None:
    try:
        for run in runs:
            if run.episodes.rows():
                curves.draw_run([run], run.path / "curve.png")
        if len(runs) > 1 and all(run.episodes.rows() for run in runs):
            curves.draw_run(runs, path / "curve.png")
    except MissingExtra as error:
        print(f"no curve.png: {error}", file=sys.stderr)
