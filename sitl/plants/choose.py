# SPDX-License-Identifier: BSD-3-Clause
"""What ``--physics`` means."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from ..errors import OptionError
from ..physics.engines import BACKENDS, backends
from ..scenario import Scenario
from .plant import Craft, Plant

LINKS = {"hil": "sitl.plants.hil", "json": "sitl.plants.json"}
"""Scheme -> module whose ``make(craft, address)`` gives a plant at the other end of a link."""
FORMS = (*BACKENDS, "hil:tcp:HOST:PORT", "json:HOST:PORT")


def is_remote(physics: str) -> bool:
    """Whether the physics is at the other end of a link.

    Raises:
        OptionError: no physics of this name.
    """
    if physics in backends():
        return False
    scheme = physics.partition(":")[0] if isinstance(physics, str) else ""
    if scheme in LINKS and ":" in physics:
        return True
    raise OptionError(f"physics {physics!r} is not known; it is one of {', '.join(FORMS)}")


def remote(craft: Craft, scenario: Scenario) -> Plant:
    """A plant at the other end of a link.

    Args:
        craft: the vehicle.
        scenario: its physics is "SCHEME:ADDRESS". Home, seed, world, start and a true estimate may belong to the
            physics side: the module of the link names those that do not (``OWN``), the others may not be given.

    Raises:
        OptionError: an option that the physics at the other end has to be told, or an address that cannot be read.
    """
    scheme, _, address = scenario.physics.partition(":")
    module = import_module(LINKS[scheme])
    estimator = scenario.estimator if scenario.estimator == "truth" else None
    given = {name: getattr(scenario, name) for name in ("home", "seed", "world", "start")} | {"estimator": estimator}
    own = {name: given[name] for name in getattr(module, "OWN", ())}
    for name, value in given.items():
        if value is not None and name not in own:
            where = scenario.physics
            raise OptionError(f"{name} = {value!r}: with physics {where} it belongs to the other end of the link")
    make: Callable[..., Plant] = module.make
    return make(craft, address, **own)
