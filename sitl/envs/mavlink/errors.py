# SPDX-License-Identifier: BSD-3-Clause
"""Errors of vehicles that environments fly."""

from __future__ import annotations

from sitl.errors import LinkLostError, VehicleError

__all__ = ["LinkLostError", "NotASimulatorError", "NotReadyError"]


class NotReadyError(VehicleError, RuntimeError):
    """A vehicle that does not become ready for an episode; the message says which texts it sent."""


class NotASimulatorError(NotReadyError):
    """A vehicle that is not reset, because nothing proves that it is a simulator; nothing was sent that changes it."""
