# SPDX-License-Identifier: BSD-3-Clause
"""What the parameters mean, for ground stations (https://mavlink.io/en/services/component_metadata.html).

COMPONENT_METADATA names a file, which names the parameters' file; both are read by MAVLink FTP.
"""

from __future__ import annotations

import json
import math
import zlib
from functools import cache
from typing import Any

from ..autopilot.params.parameter import FLOAT, INT8, INT16, INT32, Parameter, stored
from ..autopilot.params.table import Table

GENERAL, PARAMETERS = "@META/general.json", "@META/parameters.json"
_PARAMETER_TYPE = 1
"""COMP_METADATA_TYPE_PARAMETER"""
_TYPES = {INT8: "Int8", INT16: "Int16", INT32: "Int32", FLOAT: "Float"}
NO_EFFECT = "Has no effect in this simulator."


def file_crc(data: bytes) -> int:
    """CRC-32 as MAVLink FTP computes it: it begins with 0, and its bits are not inverted."""
    return zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF


@cache
def files(table: Table) -> dict[str, bytes]:
    """The files by their paths."""
    parameters = _bytes({"version": 1, "parameters": [_described(p) for p in table]})
    named = {"type": _PARAMETER_TYPE, "uri": uri(PARAMETERS), "fileCrc": file_crc(parameters)}
    return {GENERAL: _bytes({"version": 1, "metadataTypes": [named]}), PARAMETERS: parameters}


def uri(path: str) -> str:
    """How a file that FTP serves is named."""
    return f"mftp://{path}"


def _bytes(content: dict[str, Any]) -> bytes:
    return json.dumps(content, separators=(",", ":")).encode("ascii")


def _described(p: Parameter) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "name": p.name,
        "type": _TYPES[p.kind],
        "group": p.name.split("_", 1)[0],
        "category": "Standard" if p.has_effect or p.doc else "Without effect",
        "shortDesc": p.doc or NO_EFFECT,
        "default": _number(p, p.default),
    }
    if p.unit:
        entry["units"] = p.unit
    for key, value in (("min", p.low), ("max", p.high)):
        if math.isfinite(value):
            entry[key] = _number(p, value)
    if p.read_only:
        entry["volatile"] = True
    return entry


def _number(p: Parameter, value: float) -> float:
    return float(f"{stored(p, value):.7g}") if p.kind == FLOAT else int(stored(p, value))
