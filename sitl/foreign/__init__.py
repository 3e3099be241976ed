# SPDX-License-Identifier: BSD-3-Clause
"""Autopilots that are not ours, in our physics and worlds: ArduPilot's through its JSON interface, PX4 over HIL."""
