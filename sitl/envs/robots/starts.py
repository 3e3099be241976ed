# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles after boot and take-off, kept for all environments of this process.

To boot and take off takes 40 to 100 ms of processor time, a usual environment has 64 boots, and a program makes several
environments alike: to train in, to evaluate in, one for each condition of a table, one for each robot of a vector.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any

from sitl.scenario import Scenario
from sitl.simulation import Snapshot
from sitl.vehicle.core_entry import unit_address
from sitl.vehicles import Airframe
from sitl.worlds import World

from .vehicles import EpisodeState, VehicleSetup

MOST = 2048
"""Number of starts that are kept, some 200 kB each."""


class Origin:
    """What the start of a vehicle depends on, besides its pose, changed properties, the seed of its boot and the
    messages that it sends.

    Args:
        setup: what the vehicles of an environment are made from.
        world: that it boots in.
    """

    __slots__ = ("_all", "_hash", "_kind")

    def __init__(self, setup: VehicleSetup, world: World) -> None:
        kind = setup.scenario.kind
        # Plain Python may be changed at any time, as by a debugger or a test: each environment then has starts of its
        # own.
        code = unit_address(kind.advance, kind) or object()
        self._kind = setup.kind  # lives as long as its identity counts
        self._all: tuple[object, ...] = (
            kind, code, id(setup.kind), _scenario(setup.scenario), _airframe(setup.airframe), world,
            setup.options.take_off, setup.angles.tobytes(),
        )  # fmt: skip
        try:
            self._hash = hash(self._all)
        except TypeError:  # a world with lists or arrays, which can be changed: nobody else has these starts
            self._all = (object(),)
            self._hash = hash(self._all)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Origin) and self._hash == other._hash and self._all == other._all)


def _scenario(scenario: Scenario) -> Hashable:
    """A scenario without its airframe, world, start and seed, which are distinguished otherwise."""
    return (
        scenario.home, scenario.estimator, type(scenario.params), tuple(sorted(scenario.parameters.items())),
        scenario.physics, tuple(scenario.faults), scenario.terrain,
    )  # fmt: skip


def _airframe(airframe: Airframe) -> Hashable:
    properties = tuple(sorted((name, _plain(value)) for name, value in airframe.properties.items()))
    return type(airframe), airframe.name, properties, tuple(sorted(airframe.parameters.items()))


def _plain(value: Any) -> Hashable:
    """A property's value: vectors as tuples."""
    return value if isinstance(value, str) or not hasattr(value, "__len__") else tuple(map(float, value))


class Start:
    """A vehicle that an episode can begin with. It is never changed.

    Args:
        state: after take-off.
    """

    __slots__ = ("ready", "state")

    def __init__(self, state: EpisodeState) -> None:
        self.state = state
        self.ready: dict[tuple[str, int], Snapshot] = {}
        """The same in the mode and with the intervals of telemetry that an action needs: (kind of set-point, interval
        [us]) -> snapshot."""


class Starts:
    """Starts by what they depend on; those that were not used for longest go first.

    Args:
        most: number of starts that are kept.
    """

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._kept: OrderedDict[Hashable, Start] = OrderedDict()
        self._lock = threading.Lock()  # environments may be in threads

    def __len__(self) -> int:
        return len(self._kept)

    def of(self, key: Hashable, make: Callable[[], EpisodeState]) -> Start:
        """The start of a key, made where there is none."""
        with self._lock:
            if (start := self._kept.get(key)) is not None:
                self._kept.move_to_end(key)
                return start
        made = Start(make())
        with self._lock:
            start = self._kept.setdefault(key, made)
            while len(self._kept) > self._most:
                self._kept.popitem(last=False)
        return start

    def clear(self) -> None:
        """Forget all."""
        with self._lock:
            self._kept.clear()


STARTS = Starts()
"""Those of this process."""
