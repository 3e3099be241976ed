# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of runs: all that came to a vehicle from outside, with its simulated time; and flying them again."""
