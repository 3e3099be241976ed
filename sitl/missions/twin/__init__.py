# SPDX-License-Identifier: BSD-3-Clause
"""Flies the flight of a log again on our autopilot and physics, and lays the two over each other."""
