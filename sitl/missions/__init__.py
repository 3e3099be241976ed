# SPDX-License-Identifier: BSD-3-Clause
"""Recorded flights, the same flights flown here, and their comparison."""
