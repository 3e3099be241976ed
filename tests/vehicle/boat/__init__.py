# SPDX-License-Identifier: BSD-3-Clause
"""A kind of vehicle of another package: a boat that goes straight on, with one mode. No file of ``sitl`` knows it."""
