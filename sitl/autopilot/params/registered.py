# SPDX-License-Identifier: BSD-3-Clause
"""Groups of parameters that other packages add to a firmware."""

from __future__ import annotations

import re
from typing import TypeVar

from ...core.extensions import ExtensionError, Extensions
from .firmware_parameters import Parameters
from .parameter import ParameterGroup

P = TypeVar("P", bound=Parameters)

_EXTENSIONS = Extensions("SITL_PARAMETERS", "group of parameters")


def register_parameters(firmware: str, prefix: str, reference: str) -> None:
    """Give a firmware a group of parameters of another package, before the firmware is imported.

    Laws read it as ``autopilot.params.PREFIX``; its names begin with "PREFIX_", and come last on the wire.

    Args:
        firmware: "copter" or "rover".
        prefix: capital letters and digits, not taken.
        reference: where the class of the group is: "package.module:NAME", importable by that name.

    Raises:
        ExtensionError: too late, or an argument is no such text.
    """
    if not re.fullmatch(r"[A-Z][A-Z0-9]{0,9}", prefix):
        raise ExtensionError(
            f"group of parameters {reference}: prefix {prefix!r} is not 1 to 10 capital letters and digits"
        )
    _EXTENSIONS.add(f"{firmware}.{prefix}", reference)


def with_registered(firmware: str, record: type[P]) -> type[P]:
    """A firmware's record of parameters with the groups that other packages gave it.

    Raises:
        ExtensionError: one cannot be imported, is no group, or has a prefix that is taken.
    """
    return _EXTENSIONS.join(firmware, record, ParameterGroup)
