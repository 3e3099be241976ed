# SPDX-License-Identifier: BSD-3-Clause
"""An asymmetric actor and critic: PPO whose critic sees the truth, in one file of torch.

The actor sees what a real vehicle would have: the autopilot's estimate. The critic is only needed in training, in the
simulator, so it may see more: where the goal really is, true velocities, and the wind. The same PPO with a critic that
sees no more than the actor is trained beside it.

    python examples/privileged_critic.py --steps 200000

It needs torch.
"""

import argparse

import gymnasium as gym
import numpy as np

from sitl.envs.parts import Path

try:
    import torch
    from torch import nn
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install torch") from None

ID = "sitl.envs:sitl/CopterHover-v1"
ROBOTS, HORIZON, EPOCHS, BATCH = 32, 64, 8, 256
DISCOUNT, TRACE, CLIP, RATE, SCALE = 0.97, 0.95, 0.2, 1e-3, 0.3
"""SCALE: of rewards, as the networks see them."""


class TrueGoal(Path):
    """A part of one's own: the vector to the goal from where the robot really is; "goal" is from its estimate."""

    def __init__(self) -> None:
        super().__init__(1)

    def prepare(self, session) -> None:
        super().prepare(session)
        self.robot = session.robot

    def write(self, out: np.ndarray) -> None:
        out[:] = self._task.offsets_from(self.robot.true_state(), 1).reshape(out.shape)


SEEN = ["goal", "velocity", "attitude", "rates", "last_action"]
PRIVILEGED = [*SEEN, TrueGoal(), "true_velocity", "true_wind"]


class Scaler:
    """Observations with mean 0 and standard deviation 1."""

    def __init__(self, width: int) -> None:
        self.count, self.mean, self.square = 1e-4, np.zeros(width), np.ones(width)

    def __call__(self, rows: np.ndarray, learn: bool = False) -> torch.Tensor:
        if learn:
            self.count += len(rows)
            share = len(rows) / self.count
            self.mean += share * (rows.mean(axis=0) - self.mean)
            self.square += share * ((rows**2).mean(axis=0) - self.square)
        spread = np.sqrt(np.maximum(self.square - self.mean**2, 1e-6))
        return torch.as_tensor(np.clip((rows - self.mean) / spread, -5.0, 5.0), dtype=torch.float32)


def network(width: int, out: int) -> nn.Module:
    """Two hidden layers."""
    return nn.Sequential(nn.Linear(width, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), nn.Linear(64, out))


def advantages(rewards, values, ends, last) -> torch.Tensor:
    """Generalised advantage estimates, shape (steps, robots)."""
    out, trace = torch.zeros_like(rewards), torch.zeros_like(last)
    for k in reversed(range(len(rewards))):
        after = last if k == len(rewards) - 1 else values[k + 1]
        error = rewards[k] + DISCOUNT * after * (1.0 - ends[k]) - values[k]
        out[k] = trace = error + DISCOUNT * TRACE * (1.0 - ends[k]) * trace
    return out


def train(critic_parts: list, steps: int, seed: int = 1) -> tuple[float, float]:
    """Learn; the mean return of the last 100 episodes, and the share of the returns' variance that the critic explains,
    mean of the second half of the training."""
    torch.manual_seed(seed)
    env = gym.make_vec(
        ID, num_envs=ROBOTS, autoreset_mode="SameStep", sensors="gps",
        observation={"actor": SEEN, "critic": critic_parts},
    )  # fmt: skip
    widths = {name: space.shape[0] for name, space in env.single_observation_space.items()}
    scale = {name: Scaler(width) for name, width in widths.items()}
    actor, critic = network(widths["actor"], 4), network(widths["critic"], 1)
    spread = nn.Parameter(torch.full((4,), -0.7))
    learner = torch.optim.Adam([*actor.parameters(), *critic.parameters(), spread], lr=RATE)
    seen, _ = env.reset(seed=seed)
    returns, running, explained = [], np.zeros(ROBOTS), []
    for _ in range(max(steps // (ROBOTS * HORIZON), 1)):
        kept = {name: [] for name in ("actor", "critic", "action", "chance", "value", "reward", "end")}
        for _ in range(HORIZON):
            rows = {name: scale[name](value, learn=True) for name, value in seen.items()}
            with torch.no_grad():
                chosen = torch.distributions.Normal(actor(rows["actor"]), spread.exp())
                action, value = chosen.sample(), critic(rows["critic"])[:, 0]
            seen, reward, terminated, truncated, infos = env.step(action.clamp(-1.0, 1.0).numpy())
            running += reward
            done = terminated | truncated
            returns += running[done].tolist()
            running[done] = 0.0
            late = np.flatnonzero(truncated & ~terminated)
            if len(late):  # time ran out, but the task did not end: what would have come is worth something
                last = np.array([infos["final_obs"][i]["critic"] for i in late])
                with torch.no_grad():
                    reward[late] += DISCOUNT / SCALE * critic(scale["critic"](last))[:, 0].numpy()
            found = (*rows.values(), action, chosen.log_prob(action).sum(1), value, SCALE * reward, done)
            for name, one in zip(kept, found):
                kept[name].append(torch.as_tensor(one, dtype=torch.float32))
        all_of = {name: torch.stack(values) for name, values in kept.items()}
        with torch.no_grad():
            last = critic(scale["critic"](seen["critic"]))[:, 0]
        gain = advantages(all_of["reward"], all_of["value"], all_of["end"], last)
        target = gain + all_of["value"]
        explained.append(1.0 - (gain.var() / target.var()).item())
        flat = {name: value.flatten(0, 1) for name, value in {**all_of, "gain": gain, "target": target}.items()}
        for _ in range(EPOCHS):
            for at in torch.randperm(ROBOTS * HORIZON).split(BATCH):
                chosen = torch.distributions.Normal(actor(flat["actor"][at]), spread.exp())
                ratio = (chosen.log_prob(flat["action"][at]).sum(1) - flat["chance"][at]).exp()
                good = flat["gain"][at]
                good = (good - good.mean()) / (good.std() + 1e-8)
                surrogate = torch.min(ratio * good, ratio.clamp(1.0 - CLIP, 1.0 + CLIP) * good).mean()
                miss = (critic(flat["critic"][at])[:, 0] - flat["target"][at]).pow(2).mean()
                learner.zero_grad()
                (0.5 * miss - surrogate).backward()
                nn.utils.clip_grad_norm_([*actor.parameters(), *critic.parameters(), spread], 0.5)
                learner.step()
    env.close()
    late_half = explained[len(explained) // 2 :]
    return float(np.mean(returns[-100:])) if returns else float("nan"), float(np.mean(late_half))


def main() -> None:
    """Train with both critics."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=200_000, help="of each training (default 200,000)")
    options = parser.parse_args()
    torch.set_num_threads(1)
    for name, parts in (("sees what the actor sees", SEEN), ("sees the truth", PRIVILEGED)):
        mean, explained = train(parts, options.steps)
        print(f"critic {name}: return {mean:.1f}, explains {explained:.2f} of the variance", flush=True)


if __name__ == "__main__":
    main()
