# SPDX-License-Identifier: BSD-3-Clause
"""Avoidance: what is seen around the vehicle, and velocities that keep away from it and from fences."""
