# SPDX-License-Identifier: BSD-3-Clause
"""Errors that are a user's mistake: the command line prints their text without a traceback."""

from __future__ import annotations

from .autopilot.params.files import ParameterError
from .core.compile import BuildError

USER_ERRORS: tuple[type[Exception], ...] = (ParameterError, BuildError)
