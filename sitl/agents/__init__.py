# SPDX-License-Identifier: BSD-3-Clause
"""Agents that learn in the environments: tabular and deep, their runs, evaluations and reports."""
