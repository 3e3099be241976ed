# SPDX-License-Identifier: BSD-3-Clause
"""Options that several commands have."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable
from typing import Any

from sitl.core import code_in_files

from ..errors import AgentError
from ..report import curves
from ..report.statistics import scipy_stats
from ..runs.backends import BACKENDS, Workers


def positive(text: str) -> int:
    """A whole number from 1 on; "10k" and "2M" are understood."""
    factor = {"k": 1000, "M": 1_000_000}.get(text[-1:], 1)
    try:
        number = int(text if factor == 1 else text[:-1]) * factor
    except ValueError:
        number = 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 1 on")
    return number


def whole(text: str) -> int:
    """A whole number from 0 on, as a seed is."""
    try:
        number = int(text)
    except ValueError:
        number = -1
    if number < 0:
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 0 on")
    return number


def assignment(text: str) -> tuple[str, Any]:
    """NAME=VALUE; a value that is no JSON is text."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise argparse.ArgumentTypeError(f"{text!r} must be NAME=VALUE")
    try:
        return name.strip(), json.loads(value)
    except ValueError:
        return name.strip(), value


def env_option(text: str) -> tuple[str, Any]:
    """NAME=VALUE of an environment's option: what the user says here, a file may say, too."""
    name, value = assignment(text)
    code_in_files.allow_options({name: value})
    return name, value


def add_option(parser: argparse.ArgumentParser, world: str = "circuit") -> None:
    """--option of the environment; ``world``: of the example in the help."""
    parser.add_argument(
        "--option", type=env_option, action="append", metavar="NAME=VALUE",
        help=f"option of the environment, such as world={world}",
    )  # fmt: skip


def add_said_again(parser: argparse.ArgumentParser) -> None:
    """--option, of a command that changes no option: what a run's folder may say of its environment, too."""
    parser.add_argument(
        "--option", type=env_option, action="append", metavar="NAME=VALUE",
        help="option of the environment that the folder of the run names, said again: needed where it reaches outside "
        "of this process, as a world file does (sitl help learning)",
    )  # fmt: skip


def assignments(pairs: Iterable[tuple[str, Any]] | None) -> dict[str, Any]:
    """All of them.

    Raises:
        AgentError: a name comes twice.
    """
    out: dict[str, Any] = {}
    for name, value in pairs or ():
        if name in out:
            raise AgentError(f"{name} is given twice")
        out[name] = value
    return out


def add_jobs(parser: argparse.ArgumentParser) -> None:
    """--jobs, --backend, --address."""
    parser.add_argument("--jobs", type=positive, default=1, metavar="N", help="number of parallel workers (default 1)")
    parser.add_argument(
        "--backend",
        choices=BACKENDS,
        default=BACKENDS[0],
        help="workers: processes of this machine, or of a Ray cluster",
    )
    parser.add_argument(
        "--address", metavar="ADDRESS", help="address of the Ray cluster (default: $RAY_ADDRESS, else a new one here)"
    )


def workers(options: argparse.Namespace) -> Workers:
    """The workers that the options of ``add_jobs`` select.

    Raises:
        AgentError: an address without ``--backend ray``.
        MissingExtra: Ray is not installed.
    """
    return Workers(options.jobs, options.backend, options.address)


def check_report_libraries() -> None:
    """Before hours are spent: what a report needs at the end is installed.

    Raises:
        MissingExtra: matplotlib or SciPy is not installed.
    """
    curves.figure()
    scipy_stats()
