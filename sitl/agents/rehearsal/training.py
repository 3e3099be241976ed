# SPDX-License-Identifier: BSD-3-Clause
"""What a plan is tried with: a policy that learns in one simulation, and one that learns in many."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from .. import environments, recipes
from ..errors import AgentError
from ..recipes import Recipe
from .plan import Plan

PLAIN, RANDOMISED = "plain", "randomised"


def recipes_of(plan: Plan, steps: int | None = None) -> dict[str, Recipe]:
    """The plan's recipe as it is, and with its domain randomisation; both as long.

    Args:
        plan: with a recipe.
        steps: steps of a training; None: as the plan says, or else the recipe.

    Raises:
        AgentError: the plan says no recipe, or its randomisation is none of the robot's.
        MissingExtra: the algorithm needs what is not installed.
    """
    if "recipe" not in plan.training or not plan.randomise:
        raise AgentError(f"plan {plan.name}: a benchmark needs training.recipe and randomise")
    recipe = recipes.load(plan.training["recipe"])
    length: dict[str, Any] = {key: plan.training.get(key) for key in ("episodes", "steps")}
    if steps is not None:
        length = {"episodes": None, "steps": steps}
    if any(length.values()):
        recipe = replace(recipe, **length)
    env = environments.make(recipe.config())
    try:
        drawn = plan.randomisation(env.unwrapped.robot)  # type: ignore[attr-defined]
    finally:
        env.close()
    own = recipe.options.get("randomise") or {}
    name = f"{plan.name}-{{}}"
    return {
        PLAIN: replace(recipe, name=name.format(PLAIN)),
        RANDOMISED: replace(
            recipe, name=name.format(RANDOMISED), options={**recipe.options, "randomise": {**own, **drawn}}
        ),
    }
