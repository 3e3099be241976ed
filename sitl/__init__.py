# SPDX-License-Identifier: BSD-3-Clause
"""gym-sitl: an autopilot in the loop, in simulated time.

The names of ``__all__`` are loaded when they are first used: ``import sitl`` itself loads nothing but the version.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .version import __version__

if TYPE_CHECKING:
    from .bridge.links import LinkFaults
    from .errors import SitlError
    from .fleet import Fleet
    from .move import Move
    from .simulation import Simulation
    from .swarm import Swarm
    from .vehicles import names as vehicle_names
    from .worlds import names as world_names

__all__ = [
    "Fleet",
    "LinkFaults",
    "Move",
    "Simulation",
    "SitlError",
    "Swarm",
    "__version__",
    "vehicle_names",
    "world_names",
]

_LAZY = {
    "Fleet": ("fleet", "Fleet"),
    "LinkFaults": ("bridge.links", "LinkFaults"),
    "Move": ("move", "Move"),
    "Simulation": ("simulation", "Simulation"),
    "SitlError": ("errors", "SitlError"),
    "Swarm": ("swarm", "Swarm"),
    "vehicle_names": ("vehicles", "names"),
    "world_names": ("worlds", "names"),
}
"""Name -> (module, name there)."""


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(__all__)}")
    module, attribute = _LAZY[name]
    value = globals()[name] = getattr(import_module(f"{__name__}.{module}"), attribute)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
