# SPDX-License-Identifier: BSD-3-Clause
"""Steering, speed and position control of a rover, and its motors. Laws run at 50 Hz."""
