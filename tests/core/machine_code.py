# SPDX-License-Identifier: BSD-3-Clause
"""Looks into what Numba makes of laws: LLVM's optimised code, and machine code for processors that are not at hand."""

from __future__ import annotations

import re
from functools import cache
from typing import Any, NamedTuple

import pytest


class Processor(NamedTuple):
    """One that machine code is made for."""

    triple: str
    cpu: str


PROCESSORS = {
    "x86-64-v3": Processor("x86_64-unknown-linux-gnu", "x86-64-v3"),
    "aarch64": Processor("aarch64-unknown-linux-gnu", "generic"),
}
"""Both have instructions that multiply and add with one rounding."""
_FREEDOMS = r"fast|reassoc|contract|afn|arcp|nsz|nnan|ninf"
_RESULT = re.compile(rf"= (?:tail |musttail |notail )?(?:f\w+|call|select|phi) (?:{_FREEDOMS})\b.*")
_ATTRIBUTE = re.compile(r'"(?:unsafe-fp-math|approx-func-fp-math|no-(?:nans|infs|signed-zeros)-fp-math)"="true"')
_FUSED_CALL = re.compile(r"@llvm\.(?:\w+\.)*(?:fma|fmuladd|vfmadd|vfmsub)\b[\w.]*")
_FUSED = re.compile(r"^\s+(vfn?m(?:add|sub)\w*|fn?m(?:add|sub)|fml[as]l?2?|fcmla)\s.*", re.M)
_DECLARED = re.compile(r'^declare [^@\n]*@"?([\w.$]+)"?\(', re.M)
_OWN = re.compile(r"llvm\.([\w.]+?)\.(?:v\d+)?f\d+\b")
_COUNTS = re.compile(r"@llvm\.(?:x86|aarch64)\.atomic\.[\w.]+")
_REFERRED = {
    "x86-64-v3": re.compile(r"\b([A-Za-z_][\w.$]*)@(?:PLT|GOTPCREL)|^\s+(?:call|jmp)q?\s+([A-Za-z_][\w$]*)", re.M),
    "aarch64": re.compile(r":got:([A-Za-z_][\w.$]*)|^\s+bl?\s+([A-Za-z_][\w$]*)", re.M),
}


def freedoms(ir: str) -> list[str]:
    """Where a compiler is allowed to take other arithmetic than the source's, or is asked to fuse."""
    found = [match.group(0) for pattern in (_RESULT, _ATTRIBUTE, _FUSED_CALL) for match in pattern.finditer(ir)]
    return [" ".join(each.split()) for each in found]


def declared(ir: str) -> set[str]:
    """Functions that are called and not in it; LLVM's own on floating-point numbers by the bare name
    (``llvm.sin.f64``: ``sin``), and none of its other ones."""
    names = set()
    for name in _DECLARED.findall(ir):
        own = _OWN.match(name)
        if own:
            names.add(own.group(1))
        elif not name.startswith("llvm."):
            names.add(name)
    return names


@cache
def _machine(processor: str) -> Any:
    import llvmlite.binding as llvm

    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    wanted = PROCESSORS[processor]
    try:
        target = llvm.Target.from_triple(wanted.triple)
    except RuntimeError as error:
        pytest.skip(f"this build of llvmlite makes no code for {wanted.triple}: {error}")
    return target.create_target_machine(cpu=wanted.cpu, features="", opt=3, reloc="pic", codemodel="default")


def assembly(ir: str, processor: str) -> str:
    """Machine code, as text, for a processor, as Numba would make it: optimised, with its own choice of vectors."""
    import llvmlite.binding as llvm

    machine = _machine(processor)
    text = re.sub(r'target triple = ".*"', f'target triple = "{PROCESSORS[processor].triple}"', ir)
    text = re.sub(r'target datalayout = ".*"', f'target datalayout = "{machine.target_data}"', text)
    # The code of this machine's processor counts references by an instruction that others do not have.
    text = _COUNTS.sub(lambda match: "@numba_" + match.group(0)[1:].replace(".", "_"), text)
    text = text.replace("define linkonce_odr ", "define ")  # else nothing is left: nobody calls it here
    module = llvm.parse_assembly(text)
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization = tuning.slp_vectorization = True
    passes = llvm.create_pass_builder(machine, tuning)
    passes.getModulePassManager().run(module, passes)
    return machine.emit_assembly(module)


def fused(code: str) -> list[str]:
    """Instructions that multiply and add with one rounding."""
    return [" ".join(match.group(0).split()) for match in _FUSED.finditer(code)]


def referred(code: str, processor: str) -> set[str]:
    """Names outside of it that machine code refers to."""
    names = {name for pair in _REFERRED[processor].findall(code) for name in pair if name}
    return {name for name in names if not re.search(rf"^{re.escape(name)}:", code, re.M)}
