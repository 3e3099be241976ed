# SPDX-License-Identifier: BSD-3-Clause
"""The error of options that cannot be taken."""

from __future__ import annotations


class OptionError(ValueError):
    """An option of the simulation that cannot be taken."""
