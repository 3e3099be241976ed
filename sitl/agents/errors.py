# SPDX-License-Identifier: BSD-3-Clause
"""The error of what a user asks of an agent and cannot have."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from sitl.errors import OptionError, did_you_mean


class AgentError(OptionError):
    """A setting of an agent, a run folder or a model that cannot be used; the message says what can."""


class ResumeError(AgentError):
    """A training that was stopped, and that cannot be gone on with here: it is of other settings or another version."""


def check_names(given: Iterable[str], known: Sequence[str], what: str = "{!r}") -> None:
    """Check that every name is one of those known; ``what``: words for a name, with {!r} in its place.

    Raises:
        AgentError: the first that is not, with the nearest that is.
    """
    for name in given:
        if name not in known:
            hint = did_you_mean(name, known)
            raise AgentError(f"{what.format(name)} is not known; it is one of {', '.join(known)}{hint}")
