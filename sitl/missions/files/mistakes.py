# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with a mission file."""

from __future__ import annotations

from sitl.errors import OptionError


class MissionFileError(OptionError):
    """A mission file that cannot be read or written; names the file, the line or item, the value, what is allowed."""
