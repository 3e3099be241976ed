# SPDX-License-Identifier: BSD-3-Clause
"""``sitl train --recipe``: a recipe says what is trained, and other options replace single things of it."""

from __future__ import annotations

import argparse

from .. import recipes
from ..errors import AgentError
from ..runs.config import RunConfig
from .options import assignments


def add_recipe(parser: argparse.ArgumentParser) -> None:
    """--recipe."""
    shipped = ", ".join(recipes.names())
    parser.add_argument(
        "--recipe", metavar="NAME", help=f"a tuned way to learn: a .toml file, or one of {shipped}; ENV is not needed"
    )


def config_by_recipe(options: argparse.Namespace) -> RunConfig:
    """The run that ``sitl train --recipe`` asks for.

    Raises:
        AgentError: no such recipe, or it is of another environment or algorithm than the options.
        MissingExtra: its algorithm needs what is not installed.
    """
    recipe = recipes.load(options.recipe)
    for given, its, what in (
        (options.env, recipe.env, "learns in"),
        (options.algo, recipe.algorithm, "learns by"),
    ):
        if given is not None and given != its:
            raise AgentError(
                f"recipe {recipe.name} {what} {its}, not {given}; leave that out, or train without --recipe"
            )
    return recipe.config(
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
