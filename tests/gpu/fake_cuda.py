# SPDX-License-Identifier: BSD-3-Clause
"""A driver without a GPU: device memory is this machine's, and its one kernel is a function."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np


class FakeDriver:
    """What ``benchmarks.cuda_driver`` calls, as ``ctypes.CDLL`` would give it.

    Args:
        kernel: ``(fleet, ticks)``.
        dtype: of the fleet's records.
    """

    def __init__(self, kernel: Callable[[np.ndarray, int], None], dtype: np.dtype) -> None:
        self.kernel, self.dtype = kernel, dtype
        self.memory: dict[int, Any] = {}
        self.launches: list[tuple[int, int]] = []
        """Blocks, threads of a block."""

    def __getattr__(self, name: str) -> Any:
        def call(*arguments: Any) -> int:
            assert len(call.argtypes) == len(arguments), name
            act = getattr(type(self), "_" + name, None)
            if act is not None:
                act(self, *arguments)
            return 0

        setattr(self, name, call)
        return call

    def _cuDeviceGetName(self, text: Any, size: int, device: int) -> None:
        text.value = b"Fake GPU"

    def _cuDeviceGetAttribute(self, out: Any, attribute: int, device: int) -> None:
        out._obj.value = {75: 9, 76: 0}[attribute]

    def _cuMemAlloc_v2(self, out: Any, size: int) -> None:
        memory = ctypes.create_string_buffer(size)
        out._obj.value = ctypes.addressof(memory)
        self.memory[out._obj.value] = memory

    def _cuMemFree_v2(self, address: Any) -> None:
        del self.memory[address.value]

    def _cuMemcpyHtoD_v2(self, to: int, source: int, size: int) -> None:
        ctypes.memmove(to, source, size)

    _cuMemcpyDtoH_v2 = _cuMemcpyHtoD_v2

    def _cuLaunchKernel(self, function: Any, *numbers: Any) -> None:
        blocks, _, _, threads, _, _, _, _, pointers, _ = numbers
        given = [ctypes.c_int64.from_address(pointer).value for pointer in pointers]
        _, _, count, size, address, shape, strides, ticks = given
        assert count == shape and size == strides == self.dtype.itemsize and blocks * threads >= count
        fleet = np.frombuffer(self.memory[address], self.dtype)
        assert len(fleet) == count
        self.launches.append((blocks, threads))
        self.kernel(fleet, ticks)
