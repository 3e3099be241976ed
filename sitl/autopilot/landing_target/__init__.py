# SPDX-License-Identifier: BSD-3-Clause
"""A target to land on or to dock at, seen by a sensor of the vehicle (PLND_*; docs/precision-landing.md)."""
