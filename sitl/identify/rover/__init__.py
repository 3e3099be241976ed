# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a rover from its logs."""
