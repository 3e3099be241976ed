# SPDX-License-Identifier: BSD-3-Clause
"""Deep agents by stable-baselines3: DQN, PPO and SAC. Needs the extra ``rl``."""
