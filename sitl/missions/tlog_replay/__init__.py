# SPDX-License-Identifier: BSD-3-Clause
"""Flies what a ground station's .tlog shows of a real vehicle's flight, or of another simulator's."""
