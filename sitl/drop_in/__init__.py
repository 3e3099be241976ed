# SPDX-License-Identifier: BSD-3-Clause
"""``arducopter`` and ``ardurover``: executables that take the place of ArduPilot's simulator (docs/drop-in.md)."""
