# SPDX-License-Identifier: BSD-3-Clause
"""Compares two flights: where and when they differ, by how much, and whether that is within tolerances."""
