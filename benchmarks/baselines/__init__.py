# SPDX-License-Identifier: BSD-3-Clause
"""Baselines: every recipe trained with several seeds, evaluated by the true state, and what that is worth elsewhere."""
