# SPDX-License-Identifier: BSD-3-Clause
"""Errors of vehicles that environments fly."""

from __future__ import annotations

from sitl.client.errors import LinkLostError
from sitl.option_error import VehicleError

__all__ = ["LinkLostError", "NotReadyError"]


class NotReadyError(VehicleError, RuntimeError):
    """A vehicle that does not become ready for an episode; the message says which texts it sent."""
