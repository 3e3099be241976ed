# SPDX-License-Identifier: BSD-3-Clause
"""The paper's benchmark as data (Zamora et al., arXiv:1608.05742): circuit2, 3,000 episodes, one run of each."""

from __future__ import annotations

ENVIRONMENT = "GazeboCircuit2TurtlebotLIDAR-v0"
TITLES = {"qlearn": "Q-learning", "sarsa": "Sarsa"}
MEAN_REWARDS = {
    "qlearn": (-114, -79, 72, 212, 239, 282, 243, 439, 676, 503, 510, 345, 776, 805, 685),
    "sarsa": (-124, -98, -75, -43, -43, -6, 55, 65, 104, 127, 361, 164, 698, 550, 240),
}
"""Mean reward of each block of 200 episodes."""
BEST_EPISODE = {"qlearn": 2500, "sarsa": 3500}
"""Best episode, read off the paper's curves (approximate)."""
REAL_TIME_FACTOR = 60
"""Real-time factor without a window on an i7-6700 (approximate)."""
