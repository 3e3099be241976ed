# SPDX-License-Identifier: BSD-3-Clause
"""From the vehicle's record to MAVLink payloads. The only place where SI units become MAVLink's."""

from .builder import Build, Context, build, build_all, messages, register_message

__all__ = ["Build", "Context", "build", "build_all", "messages", "register_message"]
