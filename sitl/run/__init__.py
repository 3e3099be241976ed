# SPDX-License-Identifier: BSD-3-Clause
"""Runs a simulation against the wall clock, or as far as clients let it."""
