# SPDX-License-Identifier: BSD-3-Clause
"""Mental rehearsal: what was learnt in one simulation is tried in others (docs/mental-rehearsal.md)."""
