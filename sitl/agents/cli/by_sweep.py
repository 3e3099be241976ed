# SPDX-License-Identifier: BSD-3-Clause
"""``sitl train --sweep``: the same training with each combination of some values."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .. import environments
from ..report.statistics import scipy_stats
from ..report.sweep import write_table
from ..runs import folder as folders
from ..runs import sweep as sweeps
from ..runs.config import RunConfig
from ..runs.folder import RunFolder
from ..runs.sweep import OPTION, Sweep

Configure = Callable[[argparse.Namespace], RunConfig]
Open = Callable[[Path, RunConfig, argparse.Namespace], RunFolder]


def add_sweep(parser: argparse.ArgumentParser) -> None:
    """--sweep."""
    parser.add_argument(
        "--sweep",
        type=_axis,
        action="append",
        metavar="NAME=V1,V2,...",
        help=f"runs with each of these values of a setting, or of an option as {OPTION}world=maze,circuit; repeatable: "
        "each combination",
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


def tell_sweep(path: Path) -> None:
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
