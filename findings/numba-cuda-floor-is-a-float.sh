#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# numba-cuda 0.30.4 (numba 0.68.1): math.floor, math.ceil and math.trunc of a float give an integer in a function that Numba
# compiles for the processor, as in Python, and a float in one that it compiles for a GPU; round and int give an integer in both.
# So the same source can be compiled for one and not for the other: an array that is indexed by math.floor(x) % n is refused for
# the GPU ("No implementation of function getitem ... array(float64, 1d, C), float64"). Without an index nothing is said: sums and
# products go on with floats, and what needs 64 bits of an integer loses the last ones. int(math.floor(x)) is right for both.
# No GPU is needed to see it: the types are those of the compilation.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q numba==0.68.1 'numba-cuda[cu12]==0.30.4' numpy==2.4.6
"$work/venv/bin/python" - <<'PYTHON'
import math
import warnings

from numba import cuda, njit, types
from numba.core.errors import TypingError

warnings.simplefilter("ignore")
FLOAT, ARRAY = types.float64, types.Array(types.float64, 1, "C")


def on_processor(function, *arguments):
    return str(njit([arguments])(function).nopython_signatures[0].return_type)


def on_gpu(function, *arguments):
    try:
        return str(cuda.compile(function, arguments, device=True, abi="numba", cc=(9, 0))[1])
    except TypingError as error:
        return "refused: " + " ".join(str(error).split())[:180]


functions = {
    "floor": lambda x: math.floor(x),
    "ceil": lambda x: math.ceil(x),
    "trunc": lambda x: math.trunc(x),
    "round": lambda x: round(x),
    "int": lambda x: int(x),
}
found = {name: (on_processor(f, FLOAT), on_gpu(f, FLOAT)) for name, f in functions.items()}
for name, (processor, gpu) in found.items():
    print(f"{name:6} processor {processor:8} GPU {gpu}")
element = lambda a, x: a[math.floor(x) % 4]
index = on_processor(element, ARRAY, FLOAT), on_gpu(element, ARRAY, FLOAT)
print("a[math.floor(x) % 4]: processor", *index[:1])
print("a[math.floor(x) % 4]: GPU", index[1])
assert all(found[name] == ("int64", "float64") for name in ("floor", "ceil", "trunc"))
assert all(found[name] == ("int64", "int64") for name in ("round", "int"))
assert index[0] == "float64" and index[1].startswith("refused") and "getitem" in index[1]
PYTHON
