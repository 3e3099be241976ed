# SPDX-License-Identifier: BSD-3-Clause
"""The whole simulated vehicle: its record, its tick, and the kinds of vehicles there are."""
