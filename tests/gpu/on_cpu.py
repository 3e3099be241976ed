# SPDX-License-Identifier: BSD-3-Clause
"""Runs what was translated for a GPU on this machine's processor.

Numba translates laws to LLVM's language for its CUDA target, with lowering of its own; NVVM goes on from there. Here
LLVM makes code for the processor of the same modules: thread numbers come from a variable, and the C library's
functions stand in for NVIDIA's.
"""

from __future__ import annotations

import ctypes
import re
from ctypes import c_int64, c_void_p

import llvmlite.binding as llvm
import numpy as np

_THREAD = """
@sitl_thread = global i32 0
define i32 @sitl_tid.x() { %a = load i32, ptr @sitl_thread ret i32 %a }
define i32 @sitl_ntid.x() { ret i32 1 }
define i32 @sitl_ctaid.x() { ret i32 0 }
"""


def _for_host(module: str) -> str:
    """LLVM's language as it is today: NVVM's is that of LLVM 7, whose pointers have types."""
    lines = [line for line in module.splitlines() if not line.startswith(("target ", ";"))]
    text = "\n".join(lines).replace(" addrspace(4)", "").replace("addrspacecast", "bitcast")
    text = text.replace("linkonce_odr ", "").replace("common global", "weak global")
    text = re.sub(r"llvm\.nvvm\.read\.ptx\.sreg\.", "sitl_", text)
    text = re.sub(r"@\"?__nv_(\w+)\"?", r"@\1", text)
    before = ""
    while before != text:
        before, text = text, re.sub(r"(\{[^{}]*\}|\[[^][]*\]|[\w.]+)\*", "ptr", text)
    return text


class OnCpu:
    """A kernel ``(fleet, ticks)`` in LLVM's language for a GPU, as a function on arrays of records."""

    def __init__(self, name: str, modules: list[str]) -> None:
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        whole = llvm.parse_assembly(_THREAD)
        for module in modules:
            whole.link_in(llvm.parse_assembly(_for_host(module)))
        machine = llvm.Target.from_default_triple().create_target_machine(opt=1)
        self._engine = llvm.create_mcjit_compiler(whole, machine)
        self._engine.finalize_object()
        self._thread = ctypes.c_int32.from_address(self._engine.get_global_value_address("sitl_thread"))
        shape = (c_void_p, c_void_p, c_int64, c_int64, c_void_p, c_int64, c_int64, c_int64)
        self._call = ctypes.CFUNCTYPE(None, *shape)(self._engine.get_function_address(name))

    def __call__(self, fleet: np.ndarray, ticks: int) -> None:
        """As if each vehicle had a thread of its own, and one thread too many."""
        size = fleet.itemsize
        for thread in range(len(fleet) + 1):
            self._thread.value = thread
            self._call(None, None, len(fleet), size, fleet.ctypes.data, len(fleet), size, ticks)
