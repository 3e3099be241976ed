# SPDX-License-Identifier: BSD-3-Clause
"""Four copters change places in one world, as agents of a PettingZoo environment: straight on, and giving way.

    python examples/pettingzoo_swarm.py

It draws pettingzoo_swarm.png and needs matplotlib and PettingZoo.
"""

import numpy as np

try:
    import matplotlib.pyplot as plt
    import pettingzoo  # noqa: F401 - what the environment needs
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib pettingzoo") from None

from sitl.envs.swarm.parallel import SwarmEnv

COUNT = 4
APART_M = 5.0
"""Within this distance copters give way."""


def straight_on(observation: np.ndarray) -> np.ndarray:
    """Velocity north, east, up, each -1 .. 1, towards the goal."""
    north, east, down = 0.3 * observation[3:6]
    return np.clip((north, east, -down), -1.0, 1.0).astype(np.float32)


def giving_way(observation: np.ndarray) -> np.ndarray:
    """The same, away from those who are near and round them, all on the same side."""
    action = straight_on(observation)
    for north, east, *_ in observation[6:].reshape(-1, 6):
        distance = max(float(np.hypot(north, east)), 0.1)
        if distance < APART_M:
            push = 1.5 * (APART_M - distance) / (APART_M * distance)
            action[:2] += push * np.array((-north - east, -east + north))
    return np.clip(action, -1.0, 1.0)


def main() -> None:
    """Fly both, and draw the paths."""
    env = SwarmEnv("crossing", count=COUNT)
    figure, panels = plt.subplots(1, 2, figsize=(8, 4.2), sharex=True, sharey=True, layout="constrained")
    for axes, act in zip(panels, (straight_on, giving_way)):
        observations, _ = env.reset(seed=1)
        paths, hit = {agent: [] for agent in env.agents}, set()
        while env.agents:
            actions = {agent: act(observations[agent]) for agent in env.agents}
            observations, _, _, _, infos = env.step(actions)
            for agent, info in infos.items():
                paths[agent].append(info["true_place"])  # north, east, down [m]
                if info["was_hit"]:
                    hit.add(agent)
        name = act.__name__.replace("_", " ")
        print(f"{name}: {len(hit)} copters hit")
        for agent, path in paths.items():
            norths, easts, _ = zip(*path)
            (line,) = axes.plot(easts, norths)
            axes.plot(easts[0], norths[0], "s", color=line.get_color())
            if agent in hit:
                axes.plot(easts[-1], norths[-1], "kx", markersize=10)
        axes.set(xlabel="east [m]", aspect="equal", title=f"{name}: {len(hit)} of {COUNT} hit")
    panels[0].set_ylabel("north [m]")
    env.close()
    figure.savefig("pettingzoo_swarm.png", dpi=80)


if __name__ == "__main__":
    main()
