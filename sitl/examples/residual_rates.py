# SPDX-License-Identifier: BSD-3-Clause
"""A learnt residual on a controller's commands: a copter that is flown by body rates and thrust, 50 times a second.

A cascade of three proportional controllers holds the goal: position -> velocity -> lean -> body rates. It knows neither
the wind nor the thrust that the copter needs to hover, so it stays beside the goal. PPO learns what to add to its
commands (Johannink and others, "Residual reinforcement learning for robot control", ICRA 2019).

    python examples/residual_rates.py --steps 300000

It needs stable-baselines3.
"""

import argparse

import numpy as np

from sitl.envs.sb3 import Sb3VecEnv

try:
    from stable_baselines3 import PPO
    from stable_baselines3.common.vec_env import VecEnvWrapper
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install 'gym-sitl[rl]'") from None

ID, ROBOTS = "sitl/CopterHover-v1", 32
OPTIONS = {
    "setpoint": "rates", "step_time": 0.02, "max_episode_steps": 500,
    "observation": ["goal", "velocity", "attitude", "rates", "heading"],
}  # fmt: skip
RATES = np.array([4.0, 4.0, 3.0])
"""What actions of 1 are: roll, pitch, turn [rad/s]."""
HOVER = 0.5
"""Thrust that the controller takes for hovering: nobody has measured it."""
RESIDUAL = 0.3
"""Greatest share of the actions' range that is added."""
GRAVITY = 9.81


def controller(seen: np.ndarray) -> np.ndarray:
    """Actions within [-1, 1]: roll, pitch, turn rate and thrust."""
    goal, velocity, attitude = seen[:, 0:3], seen[:, 3:6], seen[:, 7:9]
    wanted = np.clip(1.0 * goal, -2.0, 2.0)
    push = np.clip(2.0 * (wanted - velocity), -4.0, 4.0)  # forward, left, up [m/s^2]
    lean = -push[:, [1, 0]] / GRAVITY  # to the left is a negative roll, forward a negative pitch
    rates = np.column_stack([6.0 * (lean - attitude), np.zeros(len(seen))]) / RATES
    thrust = HOVER * (1.0 + push[:, 2] / GRAVITY)
    return np.clip(np.column_stack([rates, 2.0 * thrust - 1.0]), -1.0, 1.0).astype(np.float32)


class Residual(VecEnvWrapper):
    """Actions are added to those of the controller."""

    def reset(self) -> np.ndarray:
        self.seen = self.venv.reset()
        return self.seen

    def step_async(self, actions: np.ndarray) -> None:
        added = controller(self.seen) + RESIDUAL * np.clip(actions, -1.0, 1.0)
        self.venv.step_async(np.clip(added, -1.0, 1.0).astype(np.float32))

    def step_wait(self):
        self.seen, rewards, ended, infos = self.venv.step_wait()
        return self.seen, rewards, ended, infos


def fly(env: Residual, act) -> str:
    """One episode of each robot: mean return, and median distances from the goal in the second half."""
    env.seed(1000)
    seen, total, true, believed = env.reset(), np.zeros(ROBOTS), [], []
    robot, task = env.venv.env.unwrapped.robot, env.venv.env.unwrapped.task
    for k in range(OPTIONS["max_episode_steps"] - 1):
        seen, rewards, *_ = env.step(act(seen))
        total += rewards
        if k >= OPTIONS["max_episode_steps"] // 2:
            true.append(np.linalg.norm(task.targets - robot.true_state()[:, :3], axis=1))
            believed.append(np.linalg.norm(seen[:, :3], axis=1))
    far = f"{np.median(true):.2f} m from the goal, {np.median(believed):.2f} m by the estimate"
    return f"return {total.mean():.2f}, {far}"


def main() -> None:
    """Fly by the controller alone, learn, and fly with what was learnt."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300_000, help="of the training (default 300,000)")
    options = parser.parse_args()
    env = Residual(Sb3VecEnv(ID, num_envs=ROBOTS, **OPTIONS))
    none = np.zeros((ROBOTS, 4), np.float32)
    print("controller alone:", fly(env, lambda seen: none), flush=True)
    policy = {"log_std_init": -1.5, "net_arch": [64, 64]}
    model = PPO(
        "MlpPolicy", env, n_steps=256, batch_size=2048, n_epochs=5, gamma=0.98, learning_rate=1e-3,
        policy_kwargs=policy, seed=1, device="cpu",
    )  # fmt: skip
    with_zeros(model)
    model.learn(options.steps)
    print("with the residual:", fly(env, lambda seen: model.predict(seen, deterministic=True)[0]))
    env.close()


def with_zeros(model: PPO) -> None:
    """The residual begins at 0: the first flights are the controller's."""
    model.policy.action_net.weight.data.zero_()
    model.policy.action_net.bias.data.zero_()


if __name__ == "__main__":
    main()
