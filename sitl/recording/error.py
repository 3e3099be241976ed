# SPDX-License-Identifier: BSD-3-Clause
"""The error of recordings."""

from __future__ import annotations

from ..errors import SitlError


class RecordingError(SitlError, ValueError):
    """A recording that cannot be written, read or flown; the message names the file, the place and the reason."""
