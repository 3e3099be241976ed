# SPDX-License-Identifier: BSD-3-Clause
"""A Turtlebot learns to drive round a circuit by Q-learning, in some seconds: thirty lines of numpy.

The state is five coarse distances of its lidar; the actions are ahead, left and right.

    python examples/q_learning.py

It draws q_learning.png and needs matplotlib.
"""

from collections import defaultdict

import gymnasium as gym
import numpy as np

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

EPISODES = 1200
LEARN, DISCOUNT = 0.2, 0.9
EXPLORE, DECAY = 0.9, 0.995
"""Share of random actions in the first episode, and by what it is multiplied after each."""

env = gym.make("sitl.envs:GazeboCircuit2TurtlebotLIDAR-v0", max_episode_steps=500)
rng = np.random.default_rng(1)
values = defaultdict(lambda: np.zeros(3))


def drive(number: int, explore: float) -> tuple[float, np.ndarray]:
    """Drive one episode and learn from each step; its reward, and the positions on its way [m]."""
    state, done, total, path = tuple(env.reset(seed=number)[0]), False, 0.0, []
    while not done:
        action = int(rng.integers(3)) if rng.random() < explore else int(np.argmax(values[state]))
        observation, reward, terminated, truncated, _ = env.step(action)
        after, done = tuple(observation), terminated or truncated
        best = 0.0 if terminated else values[after].max()
        values[state][action] += LEARN * (reward + DISCOUNT * best - values[state][action])
        state, total = after, total + float(reward)
        path.append(env.unwrapped.robot.pose[0, :2].copy())
    return total, np.array(path)


def main() -> None:
    """Learn, and draw the curve and the path that it drives in the end."""
    rewards = [drive(number, EXPLORE * DECAY**number)[0] for number in range(EPISODES)]
    mean = np.convolve(rewards, np.ones(50) / 50, "valid")
    total, path = drive(EPISODES, explore=0.0)
    print(f"mean reward of the first 50 episodes {mean[0]:.0f}, of the last 50 {mean[-1]:.0f}")
    print(f"without random actions: {len(path)} steps, reward {total:.0f}")

    figure, (curve, plan) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    curve.plot(rewards, color="0.8", linewidth=0.5, label="of each episode")
    curve.plot(np.arange(len(mean)) + 49, mean, label="mean of 50")
    curve.set(xlabel="episode", ylabel="reward")
    curve.legend(loc="upper left")
    for solid in env.unwrapped.world.solids:
        plan.fill(*solid.footprint().T, color="0.3")
    plan.plot(path[:, 0], path[:, 1])
    plan.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title=f"{len(path)} steps, reward {total:.0f}")
    figure.savefig("q_learning.png", dpi=80)


if __name__ == "__main__":
    main()
