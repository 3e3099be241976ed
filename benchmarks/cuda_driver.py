# SPDX-License-Identifier: BSD-3-Clause
"""The few calls of NVIDIA's driver that a kernel on an array of records needs, by ctypes: no other library."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, byref, c_char_p, c_int, c_int64, c_size_t, c_uint, c_void_p
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]
_SIGNATURES: dict[str, tuple[Any, ...]] = {
    "cuInit": (c_uint,),
    "cuDeviceGet": (POINTER(c_int), c_int),
    "cuDeviceGetName": (c_char_p, c_int, c_int),
    "cuDeviceGetAttribute": (POINTER(c_int), c_int, c_int),
    "cuDevicePrimaryCtxRetain": (POINTER(c_void_p), c_int),
    "cuDevicePrimaryCtxRelease_v2": (c_int,),
    "cuCtxSetCurrent": (c_void_p,),
    "cuCtxSynchronize": (),
    "cuModuleLoadData": (POINTER(c_void_p), c_char_p),
    "cuModuleUnload": (c_void_p,),
    "cuModuleGetFunction": (POINTER(c_void_p), c_void_p, c_char_p),
    "cuMemAlloc_v2": (POINTER(c_size_t), c_size_t),
    "cuMemFree_v2": (c_size_t,),
    "cuMemcpyHtoD_v2": (c_size_t, c_void_p, c_size_t),
    "cuMemcpyDtoH_v2": (c_void_p, c_size_t, c_size_t),
    "cuLaunchKernel": (c_void_p, *(c_uint,) * 7, c_void_p, POINTER(c_void_p), c_void_p),
}
_MAJOR, _MINOR = 75, 76
"""Attributes of a device: its compute capability."""


class NoGpuError(RuntimeError):
    """There is no GPU, or no driver."""


class Gpu:
    """The first NVIDIA GPU of this machine.

    Raises:
        NoGpuError: there is none.
    """

    def __init__(self) -> None:
        try:
            self._driver = ctypes.CDLL("libcuda.so.1")
        except OSError as error:
            raise NoGpuError(f"no NVIDIA driver: {error}") from None
        for name, types in _SIGNATURES.items():
            getattr(self._driver, name).argtypes = types
        device, context = c_int(), c_void_p()
        try:
            self._do("cuInit", 0)
            self._do("cuDeviceGet", byref(device), 0)
        except RuntimeError as error:
            raise NoGpuError(f"no NVIDIA GPU: {error}") from None
        self._device = device.value
        self._do("cuDevicePrimaryCtxRetain", byref(context), self._device)
        self._do("cuCtxSetCurrent", context)

    def _do(self, name: str, *arguments: Any) -> None:
        code = getattr(self._driver, name)(*arguments)
        if code != 0:
            text = c_char_p()
            self._driver.cuGetErrorString(code, byref(text))
            raise RuntimeError(f"{name}: {(text.value or b'unknown error').decode()} ({code})")

    @property
    def name(self) -> str:
        """As NVIDIA sells it."""
        text = ctypes.create_string_buffer(100)
        self._do("cuDeviceGetName", text, 100, self._device)
        return text.value.decode()

    @property
    def generation(self) -> tuple[int, int]:
        """Compute capability."""
        numbers = []
        for attribute in (_MAJOR, _MINOR):
            number = c_int()
            self._do("cuDeviceGetAttribute", byref(number), attribute, self._device)
            numbers.append(number.value)
        return numbers[0], numbers[1]

    def load(self, cubin: bytes, name: str) -> c_void_p:
        """A kernel of machine code."""
        module, function = c_void_p(), c_void_p()
        self._do("cuModuleLoadData", byref(module), cubin)
        self._do("cuModuleGetFunction", byref(function), module, name.encode())
        return function

    @contextmanager
    def holding(self, fleet: Array) -> Iterator[OnDevice]:
        """A copy of an array of records on the device, for the time of a block."""
        address = c_size_t()
        self._do("cuMemAlloc_v2", byref(address), fleet.nbytes)
        try:
            held = OnDevice(self, address.value, fleet)
            held.write(fleet)
            yield held
        finally:
            self._do("cuMemFree_v2", address)

    def close(self) -> None:
        """Let go of the GPU."""
        self._do("cuDevicePrimaryCtxRelease_v2", self._device)


class OnDevice:
    """An array of records in the memory of a GPU."""

    def __init__(self, gpu: Gpu, address: int, fleet: Array) -> None:
        self._do, self._address, self._count, self._size = gpu._do, address, len(fleet), fleet.itemsize

    def write(self, fleet: Array) -> None:
        """Copy to the device."""
        self._do("cuMemcpyHtoD_v2", self._address, fleet.ctypes.data, fleet.nbytes)

    def read(self, fleet: Array) -> None:
        """Copy back."""
        self._do("cuMemcpyDtoH_v2", fleet.ctypes.data, self._address, fleet.nbytes)

    def run(self, function: c_void_p, ticks: int, threads: int) -> None:
        """Run a kernel ``(fleet, ticks)``, ``threads`` a block, and wait for its end. Numba passes an array as seven
        numbers: two owners, length, bytes a record, address, shape, strides."""
        count, size = self._count, self._size
        numbers = [c_int64(n) for n in (0, 0, count, size, self._address, count, size, ticks)]
        pointers = (c_void_p * len(numbers))(*(ctypes.addressof(number) for number in numbers))
        blocks = -(-count // threads)
        self._do("cuLaunchKernel", function, blocks, 1, 1, threads, 1, 1, 0, None, pointers, None)
        self._do("cuCtxSynchronize")
