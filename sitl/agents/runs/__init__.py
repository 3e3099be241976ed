# SPDX-License-Identifier: BSD-3-Clause
"""Runs: an agent that learns in an environment, as a folder that says how, what came of it, and how to go on."""
