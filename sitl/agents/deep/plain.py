# SPDX-License-Identifier: BSD-3-Clause
"""State as plain data: a tree of JSON and the arrays beside it. Reading it runs nothing, unlike a pickle.

Numbers, texts, bytes, arrays, lists, tuples, tables, and the records of ``_RECORDS``: what an environment's snapshot is
made of. Floats keep their bits (JSON has their shortest text that reads back as the same number).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import IntEnum
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import AgentError

Arrays = dict[str, npt.NDArray[Any]]
_ARRAY, _SCALAR, _BYTES, _LIST, _TUPLE, _TABLE = "array", "scalar", "bytes", "list", "tuple", "table"


@cache
def _records() -> dict[str, type]:
    """Name in the file -> the class. None of them does anything when it is made."""
    from sitl.autopilot.mission.item import MissionItem
    from sitl.autopilot.mission.mission import Mission
    from sitl.bridge.bridge import BridgeState
    from sitl.bridge.channel import ChannelState
    from sitl.bridge.services.client_files import State as ClientFiles
    from sitl.envs.latency import Memory
    from sitl.envs.robots.vehicles import EpisodeState
    from sitl.envs.session import Snapshot
    from sitl.simulation import Snapshot as SimulationSnapshot

    return {
        "environment": Snapshot, "latency": Memory, "vehicle": EpisodeState, "simulation": SimulationSnapshot,
        "mission": Mission, "mission item": MissionItem, "bridge": BridgeState, "channel": ChannelState,
        "client files": ClientFiles,
    }  # fmt: skip


def encode(value: Any, arrays: Arrays) -> Any:
    """``value`` as what JSON can hold; its arrays and bytes are put into ``arrays``.

    Raises:
        AgentError: it holds something that is no plain data.
    """
    if value is None or isinstance(value, bool | str) or type(value) in (int, float):
        return value
    if isinstance(value, IntEnum):
        return int(value)
    if isinstance(value, np.ndarray | np.generic) and not value.dtype.hasobject:
        return {(_ARRAY if isinstance(value, np.ndarray) else _SCALAR): _keep(np.asarray(value), arrays)}
    if isinstance(value, bytes):
        return {_BYTES: _keep(np.frombuffer(value, np.uint8), arrays)}
    name = next((name for name, kind in _records().items() if type(value) is kind), None)
    if name is not None:
        parts = [getattr(value, field.name) for field in fields(value)] if is_dataclass(value) else list(value)
        return {name: [encode(part, arrays) for part in parts]}
    if type(value) in (list, tuple):
        return {(_LIST if type(value) is list else _TUPLE): [encode(part, arrays) for part in value]}
    if isinstance(value, Mapping):
        return {_TABLE: [[encode(key, arrays), encode(part, arrays)] for key, part in value.items()]}
    raise AgentError(f"a {type(value).__name__} cannot be kept in a run's folder: {value!r:.60}")


def decode(tree: Any, arrays: Mapping[str, npt.NDArray[Any]]) -> Any:
    """What ``encode`` was given.

    Raises:
        AgentError: the tree says what no tree says.
    """
    if tree is None or isinstance(tree, bool | int | float | str):
        return tree
    if not isinstance(tree, dict) or len(tree) != 1:
        raise AgentError(f"{tree!r:.60} is no state")
    ((kind, part),) = tree.items()
    if kind in (_ARRAY, _SCALAR, _BYTES):
        found = arrays[part]
        return found.copy() if kind == _ARRAY else found[()] if kind == _SCALAR else found.tobytes()
    if kind == _TABLE:
        return {decode(key, arrays): decode(value, arrays) for key, value in part}
    parts = [decode(one, arrays) for one in part]
    if kind in (_LIST, _TUPLE):
        return parts if kind == _LIST else tuple(parts)
    if kind not in _records():
        raise AgentError(f"{kind!r} is no record of a state")
    return _records()[kind](*parts)


def _keep(array: npt.NDArray[Any], arrays: Arrays) -> str:
    name = str(len(arrays))
    arrays[name] = array
    return name
