#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# jax 0.10.2, jax.dlpack.from_dlpack on a CPU: memory of a NumPy array is shared only where it begins at a multiple of 64 bytes.
# Elsewhere it is copied, without a word: with the default, and with copy=None. NumPy aligns to 16 bytes, so that it is chance which of
# the two one gets, and a view x[1:] of an aligned array is copied. A program that goes on writing into its array, to be seen
# by JAX, sees old numbers some of the time.
# Seen: the lines below. Fails if the second array is shared, or the first one is not.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q jax==0.10.2 numpy==2.4.6
"$work/venv/bin/python" - <<'PYTHON'
import jax
import numpy as np

room = np.zeros(64, np.float32)
first = (-room.ctypes.data % 64) // 4
for offset in (0, 4):
    ours = room[first + offset : first + offset + 8]
    theirs = jax.dlpack.from_dlpack(ours)
    ours[:] = 1.0
    shares = bool(np.asarray(theirs)[0] == 1.0)
    print(f"begins {ours.ctypes.data % 64} bytes after a multiple of 64: {'shared' if shares else 'copied'}")
    assert shares == (offset == 0)
    ours[:] = 0.0
try:
    jax.dlpack.from_dlpack(room[first + 4 : first + 12], copy=False)
    said = "taken"
except Exception as error:
    said = f"{type(error).__name__}: {error}".split("\n")[0]
print(f"copy=False: {said}")
PYTHON
