# SPDX-License-Identifier: BSD-3-Clause
"""Compares two flights: how far, where, when, and whether that is within what is allowed."""
