# SPDX-License-Identifier: BSD-3-Clause
"""The file ``@PARAM/param.pck``.

All parameters, packed, names shortened by what they share with the one before.

Format: https://ardupilot.org/dev/docs/mavlink-get-set-params.html and the readers of pymavlink and MAVProxy.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

from ...autopilot.params.parameter import FLOAT, INT8, INT16, INT32, Parameter
from ...autopilot.params.table import stored

MAGIC, MAGIC_WITH_DEFAULTS = 0x671B, 0x671C
HAS_DEFAULT = 1
_TYPES = {INT8: (1, "b"), INT16: (2, "h"), INT32: (3, "i"), FLOAT: (4, "f")}


def pack_parameters(values: Sequence[tuple[Parameter, float]], with_defaults: bool) -> bytes:
    """The file's bytes. With defaults, a parameter that differs from its default carries both."""
    magic = MAGIC_WITH_DEFAULTS if with_defaults else MAGIC
    parts = [struct.pack("<HHH", magic, len(values), len(values))]
    before = b""
    for parameter, value in values:
        name = parameter.name.encode("ascii")
        shared = 0
        while shared < min(len(name) - 1, len(before), 15) and name[shared] == before[shared]:
            shared += 1
        number, code = _TYPES[parameter.kind]
        default = stored(parameter, parameter.default)
        both = with_defaults and default != value
        flags = HAS_DEFAULT if both else 0
        parts.append(bytes((number | flags << 4, shared | (len(name) - shared - 1) << 4)) + name[shared:])
        parts.append(_number(code, value))
        if both:
            parts.append(_number(code, default))
        before = name
    return b"".join(parts)


def _number(code: str, value: float) -> bytes:
    return struct.pack("<" + code, value if code == "f" else int(value))
