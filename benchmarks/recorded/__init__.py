# SPDX-License-Identifier: BSD-3-Clause
"""Flights that a real ArduPilot SITL has flown once, and ours beside them."""
