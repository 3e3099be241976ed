# SPDX-License-Identifier: BSD-3-Clause
"""Many vehicles of one kind in one array of records, each with a client of its own on MAVLink.

One compiled call advances all of them: it acts on what their clients sent, lets time go on and sends what falls due,
split over threads if asked for. A vehicle that needs Python (a command, a parameter, a mission, a text) is served by a
simulation that all of them share: it takes the vehicle's state, does what there is to do, and gives the state back; the
others have gone on meanwhile. Each vehicle flies bit for bit as a ``Simulation`` of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from ctypes import c_int64
from dataclasses import replace
from functools import partial
from itertools import pairwise
from numbers import Real
from typing import Any, NamedTuple, Unpack, cast

import numpy as np

from .autopilot.mission.mission import Mission
from .bridge.channel import ChannelState
from .bridge.links import LinkFaults
from .bridge.links.inprocess import InProcessLink
from .bridge.services.failure_injection import FaultService
from .bridge.wire import fleet as wire
from .bridge.wire import world_records as wire_worlds
from .bridge.wire.fleet import STAYS, TO_HEAR, Slot
from .bridge.wire.port import IN_BYTES, INCOMING, OUT, STATE, Port
from .core import rng
from .core.array_kernels import Kernel
from .core.compile import Progress
from .core.kernels import jit_disabled
from .errors import OptionError
from .move import Move
from .physics.native.ranging import Ranging
from .plants.lidar import show_world
from .plants.local import LocalPlant
from .plants.surroundings import Surroundings
from .scenario import Options, Scenario
from .simulation import Simulation, Snapshot
from .vehicle.core_entry import Core, bind_fleet_unit, unit_address
from .vehicle.faults import Failure
from .vehicle.kind import load
from .vehicle.move import DONE, IN_SOLID, MoveOrder
from .vehicles import Airframe
from .worlds import World

Array = np.ndarray[Any, Any]
set_goals, any_waits = Kernel(wire.set_goals), Kernel(wire.any_waits)
run_fleet = Kernel(wire.run_fleet, lets_others_run=True)
run_in_worlds = Kernel(wire_worlds.run_in_worlds, lets_others_run=True)
_WORLDS = 256
"""Worlds whose surroundings are kept."""
_WORLD_PART = Ranging.dtype.fields["movers"][1]  # type: ignore[index]
"""So many bytes of a ``Ranging``, the first ones, say the world."""
_HELD = 8
"""Snapshots whose state is held ready, so that vehicles get it again by a copy."""


class _Held(NamedTuple):
    """What a vehicle is given of a snapshot."""

    of: Snapshot | None
    record: Array
    port: Array
    state: Snapshot
    events_seen: int
    shell_us: int


class _Worlds:
    """Worlds of the vehicles of a fleet, once they are not all in the scenario's.

    Args:
        fleet: whose vehicles are all in the scenario's world so far.
    """

    def __init__(self, fleet: Fleet) -> None:
        shell, count, threads = fleet.shell, len(fleet), fleet.threads
        plant = shell.plant
        assert isinstance(plant, LocalPlant) and plant.surroundings is not None
        self._shell = shell
        self._known = {plant.surroundings.world.name: plant.surroundings}
        self._parts: dict[str, tuple[World, Array]] = {}
        """Name of a world -> that world, and the part of a ``Ranging`` that says it."""
        self.of = [plant.surroundings] * count
        """Where each vehicle is."""
        self._rangings: Array = Ranging.fleet(count)
        self.ranging_size = self._rangings.itemsize
        for k, (address, keeper) in enumerate(fleet._workspaces):
            if address:
                own = slice(count * k // threads, count * (k + 1) // threads)
                _, memory, _ = cast(Any, keeper)
                self._rangings[own] = memory[0]  # sensors and buffers of its thread
        self.address: int = self._rangings.ctypes.data
        """Of one ``Ranging`` for each vehicle."""
        self._bytes = self._rangings.view("u1").reshape(count, -1)
        self._has_solids = fleet.records["physics"]["obstacles"]["present"]

    def ranging(self, row: int) -> int:
        """Address of a vehicle's ``Ranging``."""
        return self.address + self.ranging_size * row

    def enter(self, row: int, world: World) -> None:
        """Put a vehicle into a world."""
        around = self.around(world)
        if self.of[row] is not around:
            self.of[row] = around
            self._bytes[row, :_WORLD_PART] = self._part(around)

    def _part(self, around: Surroundings) -> Array:
        """The part of a ``Ranging`` that says what is around."""
        found = self._parts.get(around.world.name)
        if found is None or found[0] is not around.world:
            if len(self._parts) >= _WORLDS:
                del self._parts[next(iter(self._parts))]
            one = Ranging.fleet(1)
            show_world(Ranging.of(one, 0), around.world.geometry, around.floor)
            found = self._parts[around.world.name] = around.world, one.view("u1")[:_WORLD_PART].copy()
        return found[1]

    def write_solids(self, row: int) -> None:
        """Tell a vehicle's record whether there are solids in its world."""
        self._has_solids[row] = len(self.of[row].world.geometry) > 0

    def around(self, world: World) -> Surroundings:
        """What is around vehicles in a world; the last ones are kept."""
        found = self._known.pop(world.name, None)
        if found is None or found.world is not world:
            found = Surroundings(world, None, self._shell.airframe)
        self._known[world.name] = found  # the last one that was used
        if len(self._known) > max(_WORLDS, 2 * len(self.of)):
            del self._known[next(iter(self._known))]
        return found

    def let_in(self, row: int) -> None:
        """Let the shell be where a vehicle is."""
        if self._shell.world is not self.of[row].world:
            self._shell.enter(self.of[row])

    def let_in_named(self, name: str | None) -> None:
        """Let the shell be in a world that vehicles have been in; of others, it says itself that it is not there."""
        around = self._known.get(name or "")
        if around is not None and self._shell.world is not around.world:
            self._shell.enter(around)


class Fleet:
    """Vehicles of one kind, each with one client in this process.

    All begin at power-on. ``put`` gives some of them another state, such as that of a vehicle in the air.

    Args:
        frame: airframe name, path of a file that defines one, an Airframe, or a whole ``Scenario``.
        count: number of vehicles.
        threads: that advance them; their number changes no bit of the result.
        core: the core of this kind of vehicle, if it is loaded already.
        progress: called for each unit that is compiled.
        options: the other fields of ``sitl.scenario.Scenario``: home, seed, params ...; the physics is native.

    Raises:
        OptionError: ``count`` or ``threads`` is no positive whole number, or the physics is not native; and what
            ``Simulation`` raises.
    """

    def __init__(
        self,
        frame: str | Airframe | Scenario | None = None,
        count: int = 1,
        *,
        threads: int = 1,
        core: Core | None = None,
        progress: Progress | None = None,
        **options: Unpack[Options],
    ) -> None:
        for name, number in (("count", count), ("threads", threads)):
            if not isinstance(number, int) or number < 1:
                raise OptionError(f"{name} = {number!r}; a whole number from 1 on is needed")
        self.shell = shell = Simulation(frame, core=core, progress=progress, **options)
        """Serves vehicles that need Python, one after the other."""
        if not shell.plant.runs_in_core:
            raise OptionError(f"a fleet flies on native physics, not on {shell.physics}")
        self.scenario, self.kind = shell.scenario, shell.kind
        self.records: Array = shell.kind.record.fleet(count)
        """The vehicles' records (``sitl.vehicle.record``), shape (count,); their memory stays in place."""
        self.ports: Array = np.zeros(count, Port.dtype)
        """Their ends of the links (``sitl.bridge.wire.port``), shape (count,)."""
        self._slots: Array = np.zeros(count, Slot.dtype)
        self._link = InProcessLink()
        shell.bridge.add_link(self._link)
        self._is_closed = False
        self.observers: list[Callable[[], None]] = []
        """Called after each advance; they change nothing."""
        self._states: list[Snapshot] = []
        self.holds = _HELD
        """How many of the snapshots that ``put`` and ``move`` were given last are kept ready."""
        self._held: dict[int, _Held] = {}
        """Identity of a snapshot -> its state."""
        self._views: dict[int, Any] = {}
        self._before_boot_us: Array = np.zeros(count, np.int64)
        self._faulty = set[int]()
        """Vehicles whose links have faults: the shell advances them."""
        self._extra: dict[int, bytes] = {}
        """Bytes to clients that the shell sent: they come before those in the ports."""
        # Views of one field each: making one costs more than reading it.
        self._times, self._until = self.records["time_us"], self._slots["until_us"]
        self._needs_shell = self._slots["needs_shell"]
        self._events_seen, self._shell_us = self._slots["events_seen"], self._slots["shell_us"]
        self._in_size, self._out_size, self._out_count = (self.ports[n] for n in ("in_size", "out_size", "out_count"))
        self._records_u1 = self.records.view("u1").reshape(count, -1)
        self._ports_u1 = self.ports.view("u1").reshape(count, -1)
        self._shell_u1: Array = shell.fleet.view("u1")
        unit = shell.bridge.profile.core.run_all
        run: Callable[..., None] = bind_fleet_unit(unit, shell.kind, self.records, progress)
        rangers = shell.plant.rangers if isinstance(shell.plant, LocalPlant) else None
        self._workspaces = [(0, None) if rangers is None else rangers.with_own_workspace() for _ in range(threads)]
        """What each thread needs to measure in the world: its address, and what keeps it alive."""
        integer: Callable[[int], Any] = int if jit_disabled() else c_int64  # converted once
        parts = [count * k // threads for k in range(threads + 1)]
        slots, ports = self._slots.ctypes.data, self.ports
        self._slots["ports"] = ports.ctypes.data + ports.itemsize * np.arange(count)
        self._slots["clients"] = 1
        self._parts = [
            partial(run, *map(integer, (first, last, slots, workspace[0])))
            for (first, last), workspace in zip(pairwise(parts), self._workspaces, strict=True)
            if first < last
        ]
        """Each advances the vehicles of one thread."""
        self._set_goals: Callable[[int], None] = set_goals.bind(self._times, self._until)
        self._any_waits: Callable[[], bool] = any_waits.bind(self._needs_shell)
        self._run_alone: Callable[[int], bool] | None = None
        """Advances all vehicles in this thread; says whether any needs the shell."""
        if threads == 1 and not jit_disabled():
            numbers = self.records.ctypes.data, self.records.itemsize, count, slots, self._workspaces[0][0]
            self._run_alone = run_fleet.bind(unit_address(unit, shell.kind), *numbers)
        self._pool = ThreadPoolExecutor(threads, "sitl-fleet") if threads > 1 and not jit_disabled() else None
        self.threads = threads
        self._worlds: _Worlds | None = None
        """None: all vehicles are in the scenario's world."""
        self._slots_at, self._unit_at = slots, unit_address(unit, shell.kind)
        self._run_unit = run
        self._orders: Array = MoveOrder.fleet(0)
        self._order_views: list[MoveOrder] = []
        self._move_all: Callable[..., None] | None = None
        self._properties: Any = self.records["physics"]["airframe"]
        self._states = [shell.snapshot()] * count
        self.put(range(count), self._states[0])

    def __len__(self) -> int:
        return len(self.records)

    @property
    def clocks(self) -> tuple[Array, Array]:
        """Simulated time of each vehicle since it last booted, and before [us]; they stay in place, shape (count,)."""
        return self._times, self._before_boot_us

    @property
    def time_us(self) -> Array:
        """Simulated time of each vehicle since it was first powered on [us], shape (count,)."""
        found: Array = self._before_boot_us + self._times
        return found

    # ------------------------------------------------------------------ worlds

    def enter(self, which: int | Iterable[int], world: World) -> None:
        """Let vehicles be in another world from now on, each alone. Their states are not changed: ``put`` or ``move``
        them next, since what they know of solids near them is of the world before.

        Args:
            which: a vehicle, or several.
            world: whose start pose for this airframe has to be free.

        Raises:
            OptionError: the fleet is in no world, or the airframe cannot stand at the world's start.
        """
        rows = [which] if isinstance(which, int | np.integer) else list(which)
        for row in rows:
            self._check(row)
        self._check_open()
        if self._worlds is None:
            if self.shell.world is None:
                raise OptionError(f"world {world.name!r}: a fleet that was made without a world stays in none")
            self._worlds = self._separate()
        self._worlds.around(world)
        for row in rows:
            self._worlds.enter(int(row), world)

    def world(self, index: int) -> World | None:
        """The world that a vehicle is in; None: a plain without end."""
        self._check(index)
        return self.shell.world if self._worlds is None else self._worlds.of[index].world

    def _separate(self) -> _Worlds:
        """Let each vehicle measure by itself from now on."""
        worlds, count, threads = _Worlds(self), len(self), self.threads
        size, at = self.records.itemsize, (self._slots_at, worlds.address, worlds.ranging_size)
        parts = [count * k // threads for k in range(threads + 1)]
        if jit_disabled():
            run, slots = self._run_unit, self._slots_at
            self._parts = [partial(run, k, k + 1, slots, worlds.ranging(k)) for k in range(count)]
            return worlds
        run_part = run_in_worlds
        vehicles = wire_worlds.Vehicles(self._unit_at, self.records.ctypes.data, size, count)
        self._parts = [
            cast(Any, partial(run_part.bind(vehicles, first, last - first, *at), STAYS))
            for first, last in pairwise(parts)
            if first < last
        ]
        if threads == 1:
            self._run_alone = run_part.bind(vehicles, 0, count, *at)
        return worlds

    # ------------------------------------------------------------------ states

    def put(self, which: int | Iterable[int], snapshot: Snapshot, seed: int | None = None) -> None:
        """Give vehicles the state of a snapshot, made by a simulation or fleet of the same scenario.

        Args:
            which: a vehicle, or several.
            snapshot: its client is the first one, if it had any.
            seed: of the noise of all sensors from now on; None: as in the snapshot.

        Raises:
            OptionError: the snapshot is of another airframe, world or physics; no vehicle is changed.
        """
        rows = [which] if isinstance(which, int) else list(which)
        for row in rows:
            self._check(row)
            self._check_world(row, snapshot)
        self._put(rows, snapshot, seed)

    def _check_world(self, row: int, snapshot: Snapshot) -> None:
        """Refuse the snapshot of a vehicle that was in another world than this one is."""
        if self._worlds is not None and snapshot.world != (here := self._worlds.of[row].world.name):
            raise OptionError(f"the snapshot is of world {snapshot.world}, vehicle {row} is in world {here}")

    def _put(self, rows: list[int], snapshot: Snapshot, seed: int | None = None) -> None:
        self._check_open()
        held = self._held.get(id(snapshot))
        if held is None:
            if self._worlds is not None:
                self._worlds.let_in_named(snapshot.world)
            self.shell.restore(snapshot)  # refuses what cannot be put here
            self._link.receive()
            held = self._take()
            if len(self._held) >= self.holds:
                del self._held[next(iter(self._held))]
            self._held[id(snapshot)] = held = held._replace(of=snapshot)
        self._give(rows, held)
        if seed is not None:
            at = self.kind.record.fields["rng"].offset
            for row in rows:  # a view of the whole record would cost more than all else here
                rng.seed(rng.Rng(self._records_u1[row].data[at : at + rng.Rng.dtype.itemsize]), seed)

    def move(self, which: int | Iterable[int], moves: Move | Sequence[Move], snapshot: Snapshot | None = None) -> None:
        """Put vehicles elsewhere within this instant, with all that they know of positions; see docs/fleets.md.

        Args:
            which: a vehicle, or several, each once.
            moves: where to: one for all, or one for each.
            snapshot: they are given its state first, as by ``put``, but it may be of another world that the fleet has
                been in; None: from where they are.

        Raises:
            OptionError: a move that cannot be made (a number out of its limits, a position in a solid, properties with
                which the vehicle does not hover), or a snapshot as of ``put``; no vehicle is changed.
        """
        rows = [which] if isinstance(which, int | np.integer) else list(which)
        each = [moves] * len(rows) if isinstance(moves, Move) else list(moves)
        for row in rows:
            self._check(row)
        if len(each) != len(rows) or len(set(rows)) != len(rows):
            raise OptionError(f"{len(each)} moves of vehicles {rows}: each vehicle is moved once")
        for move in (moves,) if isinstance(moves, Move) else each:
            move.check(self.scenario.airframe)
        self._check_open()
        kept = [self._state_of(row) for row in rows]
        try:
            if snapshot is not None:
                self._put(rows, snapshot)
            self._obey(rows, each, None if snapshot is None else snapshot.world)
        except OptionError:
            for row, held in zip(rows, kept):
                self._give([row], held)
            raise

    def _obey(self, rows: list[int], moves: list[Move], came_from: str | None) -> None:
        kind = self.kind
        if kind.move is None:
            raise OptionError(f"vehicles of kind {kind.name} cannot be moved: the kind has no unit for it")
        if self._move_all is None:
            self._move_all = bind_fleet_unit(kind.move, kind, self.records)
        if len(self._order_views) < len(rows):
            self._orders = MoveOrder.fleet(len(rows))
            self._order_views = [MoveOrder.of(self._orders, k) for k in range(len(rows))]
        orders = self._order_views
        for order, row, move in zip(orders, rows, moves):
            v = self.view(row)
            move.write(order, int(row), v, kind)
            for name, value in move.properties.items():
                self._properties[name][row] = tuple(value) if isinstance(value, Sequence) else value
            order.other_world = False
            if move.seed is not None:
                rng.seed(v.rng, move.seed)
        if self._worlds is None:
            self._move_all(0, len(rows), self._orders.ctypes.data, self._workspaces[0][0])
        else:
            self._move_each(self._worlds, orders, rows, came_from)
        for order, row, move in zip(orders, rows, moves):
            if order.result != DONE:
                raise OptionError(self._refusal(row, move, order.result))

    def _move_each(self, worlds: _Worlds, orders: list[MoveOrder], rows: list[int], came_from: str | None) -> None:
        """Obey orders, each in its vehicle's world; ``came_from``: the world that they come from, None: the same."""
        assert self._move_all is not None
        size = self._orders.itemsize
        for k, (order, row) in enumerate(zip(orders, rows)):
            world = worlds.of[row].world
            order.other_world = came_from is not None and came_from != world.name
            worlds.write_solids(row)
            self._move_all(0, 1, self._orders.ctypes.data + k * size, worlds.ranging(row))

    def _refusal(self, row: int, move: Move, result: int) -> str:
        v, name = self.view(row), self.scenario.airframe.name
        if result == IN_SOLID:
            north, east, down = v.physics.body.pos
            return (
                f"vehicle {row} cannot be moved: at north {north:g}, east {east:g} m, {-down:g} m high, {name} would "
                f"be in a solid of world {self.world(row).name!r}"  # type: ignore[union-attr]
            )
        changed = f"properties {dict(move.properties)}, wind {move.wind}"
        return f"vehicle {row} cannot be moved: {name} does not hover with {changed}"

    def snapshot(self, index: int) -> Snapshot:
        """The state of a vehicle, for ``put`` and for ``Simulation.restore``."""
        self._check(index)
        held = self._states[index]
        port = ChannelState(0, self._ports_u1[index, :STATE].tobytes(), held.bridge.channels[0].directions)
        bridge = held.bridge._replace(channels=(port,))
        world = held.world if self._worlds is None else self._worlds.of[index].world.name
        return replace(held, record=self._records_u1[index].tobytes(), bridge=bridge, world=world)

    def simulation(self, index: int) -> Simulation:
        """A simulation of its own in the state of a vehicle: a copy, which flies on without the fleet."""
        world = None if self._worlds is None else self._worlds.of[index].world
        made = Simulation(self.scenario if world is None else replace(self.scenario, world=world, start=None))
        made.restore(self.snapshot(index))
        return made

    def view(self, index: int) -> Any:
        """The record of a vehicle, by attributes: no copy, it follows the vehicle."""
        self._check(index)
        view = self._views.get(index)
        if view is None:
            view = self._views[index] = self.kind.record.of(self.records, index)
        return view

    def mission(self, index: int) -> Mission:
        """The mission of a vehicle."""
        self._check(index)
        return self._states[index].mission

    def page(self, height: int = 480, port: int = 0) -> Any:
        """Show the fleet on a page of the browser, in a notebook as the cell's output, while it is advanced.

        Args:
            height: of the cell's output [pixels].
            port: of the page on this machine; 0: a free one.

        Returns:
            ``sitl.view.inline.FleetView``; its ``close`` ends it, ``page.address`` is where a browser finds it.

        Raises:
            MissingExtra: the extra ``view`` is not installed.
            sitl.view.page.PageAddressError: the port is taken.
        """
        return load("sitl.view.inline:FleetView")(self, height, port)

    def _check_open(self) -> None:
        if self._is_closed:
            raise OptionError("the fleet is closed")

    def _check(self, index: int) -> None:
        if not (isinstance(index, int | np.integer) and 0 <= index < len(self.records)):
            raise OptionError(f"the fleet has no vehicle {index!r}; it has 0 .. {len(self.records) - 1}")

    # ------------------------------------------------------------------ clients

    def send(self, index: int, data: bytes) -> None:
        """Bytes from a vehicle's client; it acts on them when it is advanced."""
        self._check(index)
        self._check_open()
        size = int(self._in_size[index])
        end = size + len(data)
        if end > IN_BYTES or index in self._faulty:
            self._serve(index, 0, TO_HEAR, data)
            return
        self._ports_u1[index, INCOMING + size : INCOMING + end] = np.frombuffer(data, np.uint8)
        self._in_size[index] = end

    def receive(self, index: int) -> bytes:
        """All bytes to a vehicle's client since the last call."""
        self._check(index)
        said = self._ports_u1[index, OUT : OUT + int(self._out_size[index])].tobytes()
        self._out_size[index] = self._out_count[index] = 0
        return self._extra.pop(index) + said if index in self._extra else said

    def fail(self, which: int | Iterable[int], failure: Failure | str) -> None:
        """Let something fail in vehicles, as ``Simulation.fail`` does (docs/faults.md); times count from now.

        Raises:
            OptionError: they have no such fault, or the fleet has no such vehicle; no vehicle is changed.
        """
        failure = Failure.of(failure)
        self.shell.bridge.get(FaultService).check(failure)
        for index in self._by_shell(which):
            self.shell.fail(failure)
            self._give([index], self._take())

    def repair(self, which: int | Iterable[int], unit: str = "", instance: int = 0) -> None:
        """End faults of vehicles, as ``Simulation.repair`` does.

        Raises:
            OptionError: there is no such unit, type or instance, or no such vehicle; no vehicle is changed.
        """
        self.shell.bridge.get(FaultService).repair_of(unit, instance)
        for index in self._by_shell(which):
            self.shell.repair(unit, instance)
            self._give([index], self._take())

    def _by_shell(self, which: int | Iterable[int]) -> Iterator[int]:
        """Vehicles, the shell being in the state of each."""
        rows = [which] if isinstance(which, int | np.integer) else list(which)
        for index in rows:
            self._check(index)
        self._check_open()
        for index in rows:
            if self._worlds is not None:
                self._worlds.let_in(index)
            self.shell.restore(self.snapshot(index))
            self.shell.bridge.channels[0].port._bytes[:] = self._ports_u1[index].tobytes()
            yield int(index)

    def set_link_faults(self, which: int | Iterable[int], faults: LinkFaults | None) -> None:
        """Let vehicles' links to their clients lose, delay or change frames from now on (docs/faults.md).

        The shell advances such a vehicle, which takes much longer. It flies as a ``Simulation`` whose link has these
        faults, the seed of vehicle number i being ``faults.seed + i``.

        Args:
            which: a vehicle, or several.
            faults: what happens to frames; None: nothing any more.
        """
        board = self.shell.bridge.board
        for index in self._by_shell(which):
            channel = self.shell.bridge.channels[0]
            own = replace(faults, seed=faults.seed + index) if faults is not None else None
            board.faults.give(channel, own)
            board.faults.look([channel])
            self._give([index], self._take())

    def drop_telemetry(self) -> None:
        """Throw away what clients have not received."""
        self._extra.clear()
        self._out_size[:] = self._out_count[:] = 0

    def take_shell_bytes(self) -> dict[int, bytes]:
        """Bytes to clients that the ports do not hold, by vehicle: they come before those in the ports."""
        taken, self._extra = self._extra, {}
        return taken

    # ------------------------------------------------------------------ time

    def advance(self, seconds: float, which: Sequence[int] | Array | None = None) -> None:
        """Advance vehicles by a simulated time, rounded up to whole ticks of 2.5 ms.

        Args:
            seconds: from 0 on.
            which: numbers of the vehicles; None: all.

        Raises:
            OptionError: ``seconds`` is negative or not a finite number, or the fleet has no such vehicle.
        """
        if not (isinstance(seconds, Real) and 0.0 <= seconds < math.inf):
            raise OptionError(f"cannot advance by {seconds!r} s: a number from 0 on is needed")
        for index in () if which is None else which:
            self._check(index)
        self.advance_us(round(seconds * 1e6), which)

    def advance_us(self, step_us: int | Array, which: Sequence[int] | Array | None = None) -> None:
        """The same by microseconds, one number or one for each vehicle of ``which``; ``which`` is not looked at."""
        if self._is_closed:
            self._check_open()
        run, faulty = self._run_alone or self._run_parts, self._faulty
        if which is None and not faulty and isinstance(step_us, int):
            waits, goals = run(step_us), None
        else:
            goals = self._set_each(step_us, slice(None) if which is None else which)
            waits = run(STAYS)
        if waits:
            for index in np.flatnonzero(self._needs_shell).tolist():
                self._serve(index, int(self._until[index] - self._times[index]), int(self._needs_shell[index]))
        for index, goal_us in goals or ():
            self._serve(index, goal_us - int(self._times[index]), TO_HEAR)
        for observe in self.observers:
            observe()

    def _set_each(self, step_us: int | Array, rows: Any) -> list[tuple[int, int]]:
        """Say in the slots how far vehicles are to go [us]; the others stay. So do those whose links have faults: they
        are returned, with their goals."""
        until = self._until
        until[:] = STAYS
        until[rows] = self._times[rows] + step_us
        faulty = [(index, int(until[index])) for index in sorted(self._faulty) if until[index] != STAYS]
        until[list(self._faulty)] = STAYS
        return faulty

    def _run_parts(self, step_us: int) -> bool:
        """Advance all vehicles by a time, or as their slots say (STAYS); whether any needs the shell."""
        if step_us != STAYS:
            self._set_goals(step_us)  # the parts go as the slots say
        if self._pool is None:
            for run in self._parts:
                run()
        else:
            for done in [self._pool.submit(run) for run in self._parts]:
                done.result()
        return self._any_waits()

    # ------------------------------------------------------------------ what needs Python

    def _serve(self, index: int, left_us: int, needs_shell: int, data: bytes = b"") -> None:
        """Let the shell act on ``data`` and on what the core left to it, and advance the vehicle by ``left_us``."""
        shell = self.shell
        if self._worlds is not None:
            self._worlds.let_in(index)
        shell.take_up(self._states[index], self._records_u1[index].data)
        shell.bridge.channels[0].port._bytes[:] = self._ports_u1[index].data
        self._link.send(data)
        shell.attend(needs_shell)
        shell.advance_to(shell.time_us + max(left_us, 0))
        said = self._link.receive()
        if said:
            self._extra[index] = self._extra.get(index, b"") + said
        self._records_u1[index] = self._shell_u1
        self._ports_u1[index] = np.frombuffer(shell.bridge.channels[0].port._bytes, np.uint8)
        state = shell.state()
        self._keep(index, state)
        self._before_boot_us[index] = state.before_boot_us
        self._events_seen[index], self._shell_us[index] = self._seen_by_shell()

    def _take(self) -> _Held:
        """The shell's state."""
        port = np.frombuffer(bytes(self.shell.bridge.channels[0].port._bytes), np.uint8)
        return _Held(None, self._shell_u1.copy(), port, self.shell.state(), *self._seen_by_shell())

    def _seen_by_shell(self) -> tuple[int, int]:
        """Events that the shell has acted on, and when it has something to do [us since boot]."""
        return self.shell.v.autopilot.events.count, self.shell.bridge.shell_due_us()

    def _state_of(self, row: int) -> _Held:
        """A vehicle's state."""
        seen = int(self._events_seen[row]), int(self._shell_us[row])
        return _Held(None, self._records_u1[row].copy(), self._ports_u1[row].copy(), self._states[row], *seen)

    def _give(self, rows: list[int], held: _Held) -> None:
        """Put a state into the vehicles."""
        for row in rows:
            self._records_u1[row], self._ports_u1[row] = held.record, held.port
            self._keep(row, held.state)
        self._before_boot_us[rows] = held.state.before_boot_us
        self._events_seen[rows], self._shell_us[rows] = held.events_seen, held.shell_us

    def _keep(self, row: int, state: Snapshot) -> None:
        """Note what the shell holds of a vehicle."""
        self._states[row] = state
        if state.bridge.channels[0].directions is not None:
            self._faulty.add(row)
        else:
            self._faulty.discard(row)

    def close(self) -> None:
        """Close the shell and stop the threads: the fleet can only be looked at from now on."""
        self._is_closed = True
        if self._pool is not None:
            self._pool.shutdown()
        self.shell.close()
