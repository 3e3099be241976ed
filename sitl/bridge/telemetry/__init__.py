# SPDX-License-Identifier: BSD-3-Clause
"""From the vehicle's record to MAVLink payloads. The only place where SI units become MAVLink's."""

from .builder import build, register_message

__all__ = ["build", "register_message"]
