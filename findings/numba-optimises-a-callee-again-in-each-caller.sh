#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# numba 0.68.1 (llvmlite 0.50.0): what a compiled function calls is optimised again with each caller above it. Every function has a
# module of its own; all that it calls, directly or not, is linked into that module before LLVM's passes run over it, and the result
# is linked into the next caller's, and so on. The work for a chain of calls so grows towards the square of its depth. It cannot be
# seen from outside: compiling a deep call graph just takes long, and splitting functions into smaller ones makes it longer.
# Seen: twice the depth has 2.8 and 3.3 times the text to optimise; the innermost of 32 functions is optimised 32 times.
# Where only the outermost function is called from Python, its own passes suffice: the results are the same bits without the others.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q numba==0.68.1 llvmlite==0.50.0 numpy==2.4.6
"$work/venv/bin/python" - <<'PYTHON'
from numba import njit
from numba.core.codegen import CPUCodeLibrary

optimise = CPUCodeLibrary._optimize_final_module


def chain(depth, only_the_last=False):
    """Compile functions that call each other in a row; returns (text that was optimised [characters], how often the innermost
    function was in it, a result)."""
    text = times = 0
    space = {"njit": njit}
    for k in range(depth):
        call = f"f{k - 1}(x * 1.25 + {k}.0, y)" if k else "y"
        exec(f"@njit\ndef f{k}(x, y):\n    return (x - 0.5 * y) / (1.5 + x * x) if x > y else {call} + x * y\n", space)

    def counted(self):
        nonlocal text, times
        module = str(self._final_module)
        text += len(module)
        times += "2f0B" in module  # in its symbol
        if not only_the_last or self.name.startswith(f"f{depth - 1}"):
            optimise(self)

    CPUCodeLibrary._optimize_final_module = counted
    try:
        result = space[f"f{depth - 1}"](0.25, 3.0)
    finally:
        CPUCodeLibrary._optimize_final_module = optimise
    return text, times, result.hex()


found = {depth: chain(depth) for depth in (8, 16, 32)}
for depth, (text, times, _) in found.items():
    print(f"{depth} functions: {text} characters of LLVM's text optimised, the innermost function {times} times")
for depth in (16, 32):
    print(f"twice the depth: {found[depth][0] / found[depth // 2][0]:.2f} times the text")
same = chain(32, only_the_last=True)[2] == found[32][2]
print("the outermost alone optimised: the same result:", same)
assert found[32][0] > 3.0 * found[16][0] and found[32][1] == 32 and same
PYTHON
