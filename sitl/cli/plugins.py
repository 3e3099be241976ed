# SPDX-License-Identifier: BSD-3-Clause
"""Modules of other packages that the ``sitl`` command imports before it does anything else.

A package names them by the entry-point group ``sitl.plugins``. While such a module is imported, it registers what the
package adds to the simulator: modes, parameters, messages, faults, services, physics engines (docs/extending.md).
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import metadata

from ..errors import SitlError

GROUP = "sitl.plugins"


class PluginError(SitlError):
    """A plugin cannot be imported; without it vehicles would not be those that the user has set up."""


def installed() -> Iterator[tuple[metadata.EntryPoint, Exception | None]]:
    """Import all plugins, by name; of each the error that it raised, or None."""
    for entry in sorted(metadata.entry_points(group=GROUP), key=lambda entry: entry.name):
        try:
            entry.load()
        except Exception as error:  # whatever its package does
            yield entry, error
        else:
            yield entry, None


def described(entry: metadata.EntryPoint) -> str:
    """A plugin's name, module and package."""
    package = f" of package {entry.dist.name}" if entry.dist is not None else ""
    return f"plugin {entry.name} ({entry.value}{package})"


def load() -> None:
    """Import all plugins.

    Raises:
        PluginError: one of them cannot be imported; the message names it and its package.
    """
    for entry, error in installed():
        if error is not None:
            raise PluginError(
                f"{described(entry)} cannot be loaded: {error!r}; mend or uninstall the package"
            ) from error
