# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebots in a world: no autopilot, no MAVLink."""
