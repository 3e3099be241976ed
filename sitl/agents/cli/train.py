# SPDX-License-Identifier: BSD-3-Clause
"""``sitl train``: an agent learns in an environment; its run is a folder. Recipes and sweeps say what."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from sitl.cli.view_options import add_view_options, check_view, wants_view
from sitl.errors import MissingExtra

from .. import algorithms, environments, recipes
from ..errors import AgentError
from ..report import curves
from ..report.statistics import scipy_stats
from ..report.sweep import write_table
from ..runs import folder as folders
from ..runs import sweep as sweeps
from ..runs.backends import BACKENDS
from ..runs.bar import Bar
from ..runs.config import MAX_STEPS, RunConfig, versions
from ..runs.folder import RunFolder
from ..runs.sweep import OPTION, Sweep, is_sweep
from ..runs.training import is_done, train_all
from .agent_options import add_jobs, add_option, assignment, assignments, positive, workers
from .showing_training import shown_training


def add_recipe(parser: argparse.ArgumentParser) -> None:
    """--recipe."""
    shipped = ", ".join(recipes.names())
    parser.add_argument(
        "--recipe",
        metavar="NAME",
        help=f"environment, algorithm and hyperparameters: a .toml file, or one of {shipped}; ENV is optional",
    )


def config_by_recipe(options: argparse.Namespace) -> RunConfig:
    """The run that ``sitl train --recipe`` asks for.

    Raises:
        AgentError: no such recipe, or it is of another environment or algorithm than the options.
        MissingExtra: its algorithm needs what is not installed.
    """
    recipe = recipes.load(options.recipe)
    if options.algo not in (None, recipe.algorithm):
        raise AgentError(
            f"recipe {recipe.name} trains with {recipe.algorithm}, not {options.algo}; leave --algo out, or train "
            "without --recipe"
        )
    return recipe.config(
        env=options.env,
        seed=options.seed or 0,
        episodes=options.episodes,
        steps=options.steps,
        max_steps=options.max_steps,
        options=assignments(options.option),
        settings=assignments(options.set),
    )


def folder_name(options: argparse.Namespace, config: RunConfig) -> str:
    """Default folder name of a run."""
    return config.name if options.recipe is None else recipes.load(options.recipe).name


Configure = Callable[[argparse.Namespace], RunConfig]
Open = Callable[[Path, RunConfig, argparse.Namespace], RunFolder]


def add_sweep(parser: argparse.ArgumentParser) -> None:
    """--sweep."""
    parser.add_argument(
        "--sweep",
        type=_axis,
        action="append",
        metavar="NAME=V1,V2,...",
        help=f"train with each of these values of a hyperparameter, or of an option ({OPTION}world=maze,circuit); "
        "several --sweep: all combinations",
    )


def runs_of_sweep(options: argparse.Namespace, path: Path, configure: Configure, open_: Open) -> list[RunFolder]:
    """The runs of all combinations and seeds.

    Args:
        options: with ``sweep``.
        path: path of the sweep's folder.
        configure: makes a run of options.
        open_: makes its folder, or opens it.

    Raises:
        AgentError: a name or a value that cannot be; then no folder was made.
        MissingExtra: no SciPy, which the sweep's table needs at the end.
    """
    scipy_stats()
    found = sweeps.combinations(options.sweep)
    configs = [configure(_with(options, values)) for values in found]
    environments.try_all(configs)
    Sweep.begin(path, found)
    runs = []
    for values, config in zip(found, configs):
        for seed in range(config.seed, config.seed + options.seeds):
            folder = folders.seed_folder(path / sweeps.folder_name(values), seed)
            runs.append(open_(folder, config.with_(seed=seed), options))
    return runs


def print_sweep(path: Path) -> None:
    """Write the table of a sweep, and print it."""
    file, text = write_table(Sweep.load(path))
    print(f"{text}\n{file}")


def _with(options: argparse.Namespace, values: sweeps.Values) -> argparse.Namespace:
    changed = argparse.Namespace(**vars(options))
    changed.set, changed.option = [*(options.set or ())], [*(options.option or ())]
    for name, value in values.items():
        if name.startswith(OPTION):
            changed.option.append((name.removeprefix(OPTION), value))
        else:
            changed.set.append((name, value))
    return changed


def _axis(text: str) -> tuple[str, list[Any]]:
    try:
        return sweeps.axis(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


RUNS = Path("runs")


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "train",
        description="Trains an agent and writes a run folder: config.json, episodes.csv, the model, curve.png. "
        "Ctrl-C stops the training after the episode; --resume continues it without loss.",
    )
    parser.add_argument("env", nargs="?", metavar="ENV", help="id of an environment, such as sitl/CopterHover-v1")
    add_recipe(parser)
    parser.add_argument(
        "--algo",
        choices=tuple(algorithms.ALGORITHMS),
        help="default: qlearn (tabular); dqn, ppo and sac need the extra rl",
    )
    parser.add_argument(
        "--episodes", type=positive, metavar="N", help="length of the training in episodes (default: of the algorithm)"
    )
    parser.add_argument("--steps", type=positive, metavar="N", help="length of the training in steps")
    parser.add_argument(
        "--max-steps", type=positive, metavar="N", help=f"time limit of an episode in steps (default {MAX_STEPS})"
    )
    parser.add_argument("--seed", type=int, metavar="N", help="seed of the (first) run (default 0)")
    parser.add_argument(
        "--seeds", type=positive, default=1, metavar="N", help="number of runs, each with the next seed (default 1)"
    )
    add_jobs(parser)
    parser.add_argument(
        "--set",
        type=assignment,
        action="append",
        metavar="NAME=VALUE",
        help="hyperparameter, such as alpha=0.1 (sitl help learning)",
    )
    add_option(parser, "maze")
    add_sweep(parser)
    add_view_options(parser)
    parser.add_argument("--out", type=Path, metavar="RUN", help="folder (default: runs/ENV-ALGO, runs/RECIPE)")
    parser.add_argument(
        "--resume", nargs="?", const="", metavar="RUN", help="continue a run: RUN, or that of ENV and --out"
    )
    parser.set_defaults(function=train)


def train(options: argparse.Namespace) -> int:
    """Run the command."""
    check_view(options)
    pool = workers(options)
    if wants_view(options) and (pool.jobs > 1 or options.backend != BACKENDS[0]):
        raise AgentError("--view shows a run that is trained in this process: leave --jobs and --backend out")
    path, runs = _runs(options)
    if all(is_done(run) for run in runs):
        if is_sweep(path):
            print_sweep(path)
        print(f"{path} is done; a greater --episodes or --steps continues it")
        return 0
    with Bar(runs) as bar, shown_training(options) as shows:
        done = train_all([run.path for run in runs], pool.jobs, bar, pool.each, shows)
        summary = f"{bar.steps:,} steps in {bar.wall_s:.1f} s: {bar.speed()}"
    for folder, group in _groups(path, runs).items():
        _draw(folder, group)
    print(summary, file=sys.stderr)
    if not done:
        print(f"interrupted; continue with: sitl train --resume {path}", file=sys.stderr)
        return 130
    if is_sweep(path):
        print_sweep(path)
    print(path)
    return 0


def _groups(path: Path, runs: list[RunFolder]) -> dict[Path, list[RunFolder]]:
    if not is_sweep(path):
        return {path: runs}
    return {path / name: group for name, group in Sweep.load(path).groups().items()}


def _runs(options: argparse.Namespace) -> tuple[Path, list[RunFolder]]:
    """The folder, and the runs in it that shall be trained."""
    if options.resume and options.env is None and options.recipe is None:
        alone = AgentError(
            "--resume RUN continues a run with its own settings: give --episodes, --steps or --jobs, nothing else"
        )
        if options.out is not None or any((options.algo, options.set, options.sweep, options.max_steps)):
            raise alone
        path, said = Path(options.resume), assignments(options.option)
        runs = [run for group in _groups(path, []).values() for run in group] or folders.find(path)
        for run in runs:
            if {**run.config.env_options, **said} != run.config.env_options:  # the same may be said again
                raise alone
            run.extend(options.episodes, options.steps)
        return path, runs
    if options.env is None and options.recipe is None:
        raise AgentError(
            "ENV is missing: the id of an environment, such as GazeboCircuit2TurtlebotLIDAR-v0, or --recipe"
        )
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
        raise AgentError(
            f"{path} was started with other {', '.join(different)}; --resume {path} alone continues it unchanged"
        )
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
