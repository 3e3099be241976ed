# SPDX-License-Identifier: BSD-3-Clause
"""From the vehicle's record to MAVLink payloads. The only place where SI units become MAVLink's."""

from .builder import Build, Builder, Context, build_all, register_builder

__all__ = ["Build", "Builder", "Context", "build_all", "register_builder"]
