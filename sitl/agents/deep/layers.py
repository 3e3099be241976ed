# SPDX-License-Identifier: BSD-3-Clause
"""Layers of networks as laws: the same bits on any processor.

Each output adds up its products in the order of the inputs. A processor may work on many outputs at once, which changes
nothing in any of them; a BLAS, or NumPy's ``tanh``, gives other last bits on other processors.
"""

from __future__ import annotations

import numpy as np

from sitl.core.array_kernels import Kernel, NarrowLine, NarrowTable
from sitl.core.kernels import law

from .narrow import narrow_tanh

PLAIN, TANH, RELU = 0, 1, 2
"""What is done with an output."""


@law
def write_layer(weights: NarrowTable, bias: NarrowLine, activation: int, rows: NarrowTable, out: NarrowTable) -> None:
    """Outputs of one layer.

    Args:
        weights: shape (inputs, outputs).
        bias: shape (outputs,).
        activation: ``PLAIN``, ``TANH`` or ``RELU``.
        rows: its inputs, shape (count, inputs).
        out: its outputs, shape (count, outputs); written.
    """
    inputs, outputs = weights.shape
    by_fours = inputs - inputs % 4
    for k in range(len(rows)):
        sums = out[k]
        for j in range(outputs):
            sums[j] = np.float32(0.0)
        for i in range(0, by_fours, 4):  # four at a time: sums are read and written a quarter as often
            a, b, c, d = rows[k, i], rows[k, i + 1], rows[k, i + 2], rows[k, i + 3]
            for j in range(outputs):
                s = sums[j] + a * weights[i, j] + b * weights[i + 1, j]
                sums[j] = s + c * weights[i + 2, j] + d * weights[i + 3, j]
        for i in range(by_fours, inputs):
            a = rows[k, i]
            for j in range(outputs):
                sums[j] += a * weights[i, j]
        for j in range(outputs):
            sums[j] += bias[j]
        if activation == TANH:
            for j in range(outputs):
                sums[j] = np.float32(narrow_tanh(float(sums[j])))
        elif activation == RELU:
            for j in range(outputs):
                sums[j] = np.float32(0.0) if sums[j] < np.float32(0.0) else sums[j]


layer = Kernel(write_layer)
