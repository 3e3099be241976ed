# SPDX-License-Identifier: BSD-3-Clause
"""Optional dependencies."""

from __future__ import annotations

from ..errors import SitlError


class MissingExtra(SitlError, RuntimeError):
    """An optional dependency is not installed; the message says which extra brings it."""
