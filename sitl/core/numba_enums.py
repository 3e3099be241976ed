# SPDX-License-Identifier: BSD-3-Clause
"""Members of an ``IntEnum`` in laws, known to Numba when this is imported: each is its number.

Numba gives members a type of their own, for which there is no ``float``, and compiles a law once for members and once
for integers. Here their type is that of the number.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core.typing.templates import AttributeTemplate, infer_getattr


@infer_getattr
class _Members(AttributeTemplate):
    """``Choice.NAME``; Numba's own lowering gives the constant."""

    key = types.IntEnumClass

    def generic_resolve(self, typ: Any, name: str) -> Any:
        return typ.dtype if name in typ.instance_class.__members__ else None
