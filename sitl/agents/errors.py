# SPDX-License-Identifier: BSD-3-Clause
"""The error of what a user asks of an agent and cannot have."""

from __future__ import annotations

from sitl.errors import OptionError


class AgentError(OptionError):
    """A setting of an agent, a run folder or a model that cannot be used; the message says what can."""
