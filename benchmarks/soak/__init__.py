# SPDX-License-Identifier: BSD-3-Clause
"""Fuzz and soak: random clients, faults and reboots against a vehicle, with what must hold at all times."""
