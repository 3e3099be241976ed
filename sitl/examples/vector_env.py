# SPDX-License-Identifier: BSD-3-Clause
"""64 copters in one vector environment: random actions beside a controller of three lines.

One compiled call steps all of them, each with its autopilot and MAVLink; observations and rewards are arrays.

    python examples/vector_env.py

It draws vector_env.png and needs matplotlib.
"""

import gymnasium as gym
import numpy as np

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

ID = "sitl.envs:sitl/CopterWaypoint-v1"
ROBOTS, STEPS = 64, 150


def towards_the_target(observations: np.ndarray) -> np.ndarray:
    """Actions: fly along the way to the target (ahead, left, above [m]), and do not turn."""
    actions = np.zeros((ROBOTS, 4), np.float32)
    actions[:, :3] = np.clip(0.15 * observations[:, :3], -1.0, 1.0)
    return actions


def main() -> None:
    """Fly both, and draw where the copters go and what they are paid. Who has arrived begins anew (autoreset)."""
    env = gym.make_vec(ID, num_envs=ROBOTS)
    env.action_space.seed(1)
    agents = {"random": lambda observations: env.action_space.sample(), "towards the target": towards_the_target}
    figure, (*plans, curve) = plt.subplots(1, 3, figsize=(9, 3.2), layout="constrained")
    for axes, (name, act) in zip(plans, agents.items()):
        observations, _ = env.reset(seed=1)
        paid, arrived, paths = [], 0, []
        for _ in range(STEPS):
            observations, rewards, terminated, _, infos = env.step(act(observations))
            paid.append(rewards.mean())
            arrived += int(infos["is_success"][terminated].sum())
            paths.append(env.unwrapped.robot.pose[:, :2].copy())
        print(f"{name}: {sum(paid):.1f} on average in {STEPS} steps, {arrived} arrivals")
        axes.plot(*np.array(paths).transpose(2, 0, 1), ".", color="tab:blue", markersize=0.5)
        axes.set(xlim=(-13, 13), ylim=(-13, 13), xlabel="x [m]", ylabel="y [m]", aspect="equal")
        axes.set_title(f"{name}: {arrived} arrivals")
        curve.plot(np.cumsum(paid), label=name)
    curve.set(xlabel="step", ylabel="reward so far, mean")
    curve.legend()
    figure.savefig("vector_env.png", dpi=80)


if __name__ == "__main__":
    main()
