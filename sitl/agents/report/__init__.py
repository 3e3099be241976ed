# SPDX-License-Identifier: BSD-3-Clause
"""Reports on runs: curves, tables, statistics over seeds."""
