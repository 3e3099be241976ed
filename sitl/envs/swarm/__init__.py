# SPDX-License-Identifier: BSD-3-Clause
"""Environments of several agents, each an autopilot, in one world: PettingZoo's parallel interface (docs/swarm.md)."""
