# SPDX-License-Identifier: BSD-3-Clause
"""Functions of the C library that laws may call, by their address.

For loops that would spend more time in Python than in their work. Only what has a compiled caller can use them: plain
Python has the same functions elsewhere.
"""

from __future__ import annotations

import ctypes


def call_system(address: int, n0: int, n1: int, n2: int, n3: int, n4: int) -> int:
    """Call a C function of up to five integers or pointers that returns an ``int``.

    Args:
        address: of the function (``function_address``).
        n0, n1, n2, n3, n4: its arguments; 0 for those that it does not take.
    """
    function = ctypes.CFUNCTYPE(ctypes.c_int, *[ctypes.c_int64] * 5)(address)
    return int(function(n0, n1, n2, n3, n4))


def function_address(name: str) -> int:
    """Where a function of the C library is; 0: this system has none of this name."""
    try:
        function = getattr(ctypes.CDLL(None), name)
    except (AttributeError, OSError, TypeError):
        return 0
    return ctypes.cast(function, ctypes.c_void_p).value or 0
