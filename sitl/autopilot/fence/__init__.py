# SPDX-License-Identifier: BSD-3-Clause
"""Fences: limits in height, a circle around home, and areas to stay in or out of."""
