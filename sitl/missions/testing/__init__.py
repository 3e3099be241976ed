# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles in tests: a pytest plugin with fixtures ``copter``, ``rover``, ``vehicle_factory``, and golden flights."""
