# SPDX-License-Identifier: BSD-3-Clause
"""A hierarchical controller: a learnt outer loop moves the sticks of LOITER, five times a second.

The inner loops are the autopilot's: LOITER takes sticks as wanted velocities, brakes when they are centred, holds the
position, and leans against the wind, 400 times a second. What is learnt is what a pilot learns: how far to move which
stick, and when to let go. Beside it a pilot by rule: sticks in proportion to the distance to the goal, less the
velocity.

    python examples/loiter_sticks.py --steps 200000

It needs stable-baselines3.
"""

import argparse

import numpy as np

from sitl.envs.sb3 import Sb3VecEnv

try:
    from stable_baselines3 import PPO
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install 'gym-sitl[rl]'") from None

ID, ROBOTS, STEPS = "sitl/CopterWaypoint-v1", 32, 100
OPTIONS = {
    "setpoint": "loiter", "step_time": 0.2, "max_episode_steps": STEPS,
    "observation": ["goal", "velocity", "attitude", "last_action"],
}  # fmt: skip
GAIN, DAMPING = 0.2, 0.15
"""Stick for 1 m to the goal, and against 1 m/s."""


def centred(seen: np.ndarray) -> np.ndarray:
    """Nobody touches the sticks: the copter stays where it is."""
    return np.zeros((len(seen), 4), np.float32)


def by_rule(seen: np.ndarray) -> np.ndarray:
    """Roll right, pitch back, throttle up, yaw right: what actions of 1 are."""
    ahead, left, up = (GAIN * seen[:, 0:3] - DAMPING * seen[:, 3:6]).T
    sticks = np.column_stack([-left, -ahead, 2.0 * up, np.zeros(len(seen))])
    return np.clip(sticks, -1.0, 1.0).astype(np.float32)


def fly(env: Sb3VecEnv, act) -> str:
    """One episode of each robot: how many reach the goal, how fast, and the mean return."""
    env.seed(1000)
    seen = env.reset()
    total, took, reached = np.zeros(ROBOTS), np.zeros(ROBOTS), np.zeros(ROBOTS, bool)
    flies = np.ones(ROBOTS, bool)
    for _ in range(STEPS):
        seen, rewards, ended, infos = env.step(act(seen))
        total[flies] += rewards[flies]
        took[flies] += OPTIONS["step_time"]
        for k in np.flatnonzero(flies & ended):
            reached[k] = infos[k]["is_success"]
        flies &= ~ended
    seconds = f"{took[reached].mean():.1f} s" if reached.any() else "-"
    return f"reaches {reached.sum()} of {ROBOTS}, in {seconds}, return {total.mean():.1f}"


def main() -> None:
    """Fly with centred sticks and by rule, learn, and fly with what was learnt."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=200_000, help="of the training (default 200,000)")
    options = parser.parse_args()
    env = Sb3VecEnv(ID, num_envs=ROBOTS, **OPTIONS)
    print("centred sticks:", fly(env, centred), flush=True)
    print("by rule:", fly(env, by_rule), flush=True)
    model = PPO(
        "MlpPolicy", env, n_steps=128, batch_size=1024, n_epochs=5, gamma=0.98, learning_rate=1e-3,
        policy_kwargs={"log_std_init": -0.7, "net_arch": [64, 64]}, seed=1, device="cpu",
    )  # fmt: skip
    model.learn(options.steps)
    print("learnt:", fly(env, lambda seen: model.predict(seen, deterministic=True)[0]))
    env.close()


if __name__ == "__main__":
    main()
