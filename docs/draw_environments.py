# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_environments.py [NAME...]``: pictures of the pages in envs/, each of one episode of a baseline."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
from make_environment_pages import HERE, TITLES, spelling
from PIL import Image

from sitl.agents import baselines, environments, learnt

SEED = 1000
COLOURS, WIDTH = 48, 480
"""Of a picture."""


def picture(name: str, path: Path) -> Any:
    """The end of the first episode that ``sitl rollout --seed 1000`` plays, by the environment's own renderer."""
    found = learnt.load(path)
    env = gym.make(f"sitl/{name}-v0", render_mode="rgb_array", **found.config.env_options)
    seed = environments.seed_of(SEED, 0)
    observation, _ = env.reset(seed=seed)
    found.policy.begin(seed)
    ended = False
    while not ended:
        observation, _, terminated, truncated, _ = env.step(found.policy.act(observation))
        ended = terminated or truncated
    shown = env.render()
    env.close()
    image = Image.fromarray(shown)  # type: ignore[arg-type]
    smaller = image.resize((WIDTH, round(image.height * WIDTH / image.width)), Image.Resampling.LANCZOS)
    return smaller.quantize(COLOURS, Image.Quantize.MAXCOVERAGE)


def main() -> None:
    """Draw them."""
    (HERE / "images").mkdir(exist_ok=True)
    for name in sys.argv[1:] or TITLES:
        path = baselines.file(spelling(name))
        if path.exists():
            picture(name, path).save(HERE / "images" / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
