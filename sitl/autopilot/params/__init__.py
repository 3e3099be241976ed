# SPDX-License-Identifier: BSD-3-Clause
"""The firmware's parameters, under ArduPilot's names and with ArduPilot's defaults."""
