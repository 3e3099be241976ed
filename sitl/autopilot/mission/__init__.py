# SPDX-License-Identifier: BSD-3-Clause
"""Missions: items, their validation and files,
and the sequencer that gives the core one command after the other.
"""
