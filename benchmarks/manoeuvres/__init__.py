# SPDX-License-Identifier: BSD-3-Clause
"""The same manoeuvres flown by this simulator and by a real ArduPilot's executables, and their metrics side by side."""
