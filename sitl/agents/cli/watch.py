# SPDX-License-Identifier: BSD-3-Clause
"""``sitl watch``: what a run has learnt, on the page in the browser, in a window or as a film."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import showing
from ..errors import AgentError
from ..runs import folder as folders
from .agent_options import add_option, assignments, positive, whole

SPEED = 5.0


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "watch",
        description="Shows greedy episodes of a run's best agent: in the browser (extra view, sitl help view), in a "
        "window, or as a GIF or MP4.",
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="run folder; of several runs the first is shown")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write a .gif, or an .mp4 (needs ffmpeg)")
    parser.add_argument("--window", action="store_true", help="use a window, also if the extra view is installed")
    parser.add_argument(
        "--episodes", type=positive, metavar="N", help="number of episodes (default 1; in the browser: until Ctrl-C)"
    )
    parser.add_argument(
        "--max-steps", type=positive, metavar="N", help="time limit of an episode in steps (default: of the run)"
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="seed of the episodes (default 0)")
    parser.add_argument(
        "--speed", type=_factor, default=SPEED, metavar="X", help=f"speed, times real time (default {SPEED:g})"
    )
    add_option(parser)
    parser.set_defaults(function=watch)


def watch(options: argparse.Namespace) -> int:
    """Run the command."""
    run = folders.find(options.run)[0]
    if options.max_steps is not None:
        run.config = run.config.with_(max_steps=options.max_steps)
    changes = assignments(options.option)
    if "render_mode" in changes:
        raise AgentError("render_mode is chosen by --out: with it a film, without it a window")
    episodes = options.episodes or 1
    if options.out is None and not options.window and showing.can_be_on_page(run, **changes):
        showing.page(run, options.episodes, options.seed, options.speed, _print_episode, **changes)
        return 0
    if options.out is None:
        showing.window(run, episodes, options.seed, options.speed, _print_episode, **changes)
        return 0
    pictures = showing.film(run, options.out, episodes, options.seed, options.speed, _print_episode, **changes)
    print(f"{options.out}: {pictures} pictures")
    return 0


def _print_episode(episode: int, steps: int, reward: float, terminated: bool) -> None:
    print(f"episode {episode}: {steps} steps, reward {reward:.0f}{', ended by itself' if terminated else ''}")


def _factor(text: str) -> float:
    try:
        factor = float(text)
    except ValueError:
        factor = 0.0
    if not 0.01 <= factor <= 10_000.0:
        raise argparse.ArgumentTypeError(f"{text!r} must be a number from 0.01 to 10000")
    return factor
