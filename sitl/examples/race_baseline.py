# SPDX-License-Identifier: BSD-3-Clause
"""A race between walls: a random agent, and a policy that comes with the package.

The policy is a small network in a file of NumPy; `sitl train --recipe rover-race` learns it anew.

    python examples/race_baseline.py

It draws race_baseline.png and needs matplotlib.
"""

import gymnasium as gym
import numpy as np

from sitl.agents import baselines, learnt

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

SEED = 7


def drive(env: gym.Env, act) -> tuple[np.ndarray, float, dict]:
    """One episode: its positions x, y [m], its reward, and what the last step tells."""
    observation, _ = env.reset(seed=SEED)
    path, total, done = [], 0.0, False
    while not done:
        observation, reward, terminated, truncated, info = env.step(act(observation))
        path.append(info["true_pose"][:2])
        total, done = total + float(reward), terminated or truncated
    return np.array(path), total, info


def main() -> None:
    """Drive both, and draw the track."""
    found = learnt.load(baselines.file("rover-race"))
    found.policy.begin(SEED)
    env = gym.make("sitl.envs:sitl/RoverRace-v1", world="track:seed=1", **found.config.env_options)
    env.action_space.seed(SEED)
    figure, panels = plt.subplots(1, 2, figsize=(8, 4.2), sharey=True, layout="constrained")
    agents = {"random": lambda observation: env.action_space.sample(), "rover-race": found.policy.act}
    for axes, (name, act) in zip(panels, agents.items()):
        path, total, info = drive(env, act)
        laps = f"best lap {info['best_lap']:.1f} s" if info["is_success"] else f"{info['passed']} gates passed"
        print(f"{name}: reward {total:.0f}, {laps}")
        world = env.unwrapped.world
        for solid in world.solids:
            axes.fill(*solid.footprint().T, color="0.3")
        for gate in (marking for marking in world.markings if marking.name.startswith("gate")):
            axes.fill(*gate.footprint().T, color="tab:green", alpha=0.4)
        axes.plot(*path.T, color="tab:blue")
        axes.plot(*path[0], "o", color="tab:orange", label="start")
        axes.set(xlabel="x [m]", aspect="equal", title=f"{name}: {laps}")
    panels[0].set_ylabel("y [m]")
    panels[0].legend(loc="center")
    figure.savefig("race_baseline.png", dpi=80)


if __name__ == "__main__":
    main()
