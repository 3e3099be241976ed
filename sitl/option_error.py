# SPDX-License-Identifier: BSD-3-Clause
"""Errors of what a user asks for and cannot have, that other packages derive theirs from."""

from __future__ import annotations


class OptionError(ValueError):
    """An option of the simulation that cannot be taken."""


class VehicleError(Exception):
    """A vehicle that cannot be reached, or does not do what it must; the message says which, and what it told."""
