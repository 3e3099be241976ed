# SPDX-License-Identifier: BSD-3-Clause
"""Physics of the Turtlebot: two driven wheels on a flat floor, walls that stop it, a planar lidar. No autopilot."""
