# SPDX-License-Identifier: BSD-3-Clause
"""The runs of recipes over some seeds: made where they are not there yet, gone on with where they are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sitl.core.extras import MissingExtra

from .. import environments
from ..errors import AgentError
from ..runs import folder as folders
from ..runs.folder import RunFolder
from .recipe import Recipe


def check_all(recipes: Sequence[Recipe], seeds: int) -> None:
    """Check that all recipes can be trained, before any training starts.

    Raises:
        MissingExtra: some need what is not installed; the message says which do not.
        AgentError: a recipe that cannot be used, or two of one name.
    """
    chosen = [recipe.name for recipe in recipes]
    for name in chosen:
        if chosen.count(name) > 1:
            raise AgentError(f"there are two recipes {name!r}; each needs a folder of its own")
    missing: dict[str, MissingExtra] = {}
    for recipe in recipes:
        try:
            config = recipe.config(seeds - 1)
            try:
                environments.try_all([config])
            except AgentError as error:
                raise AgentError(f"recipe {recipe.name}: {error}") from None
        except MissingExtra as error:
            missing[recipe.name] = error
    if missing:
        rest = [name for name in chosen if name not in missing]
        hint = f"; without: --only {' '.join(rest)}" if rest else ""
        raise MissingExtra(f"recipes {', '.join(missing)}: {next(iter(missing.values()))}{hint}")


def runs_of(out: Path, recipe: Recipe, seeds: int) -> list[RunFolder]:
    """The runs of a recipe, made where they are not there yet, and at least as long as it says.

    Raises:
        AgentError: there are other runs in their place.
    """
    place = out / "runs" / recipe.name
    return [RunFolder.ensure(folders.seed_folder(place, seed), recipe.config(seed)) for seed in range(seeds)]
