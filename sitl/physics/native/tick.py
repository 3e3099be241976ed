# SPDX-License-Identifier: BSD-3-Clause
"""One tick of the simulated world: 400 Hz."""

TICK_US = 2500
TICK_S = 0.0025
