# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from sitl.agents.deep import layers, narrow
from sitl.agents.deep.network import ACTIVATIONS, Layer, Network
from sitl.agents.errors import AgentError


def _network(*widths: int, activation: str = "tanh", chooses: bool = False) -> Network:
    rng = np.random.default_rng(1)
    stages = [
        Layer((rng.normal(size=(b, a)) / math.sqrt(a)).astype(np.float32), np.full(b, 0.1, np.float32), activation)
        for a, b in itertools.pairwise(widths)
    ]
    return Network(stages, chooses)


def test_a_layer_adds_up_in_the_order_of_its_inputs() -> None:
    """In machine code, which does many outputs at once, and in plain Python alike."""
    rng = np.random.default_rng(2)
    for inputs, outputs in ((1, 1), (3, 2), (7, 33), (16, 5)):
        weights, rows = rng.normal(size=(inputs, outputs)), rng.normal(size=(3, inputs))
        weights, rows, bias = weights.astype(np.float32), rows.astype(np.float32), np.ones(outputs, np.float32)
        for activation in ACTIVATIONS.values():
            compiled, plain = np.empty((3, outputs), np.float32), np.empty((3, outputs), np.float32)
            layers.layer(weights, bias, activation, rows, compiled)
            layers.write_layer(weights, bias, activation, rows, plain)
            assert np.array_equal(compiled, plain)
        sums = np.zeros((3, outputs), np.float32)
        for k in range(inputs):
            sums = sums + rows[:, k : k + 1] * weights[k]
        layers.layer(weights, bias, layers.PLAIN, rows, compiled)
        assert np.array_equal(compiled, sums + bias)


def test_a_network_gives_what_products_of_matrices_give_to_rounding() -> None:
    rows = np.random.default_rng(3).normal(size=(20, 9)).astype(np.float32)
    network = _network(9, 32, 4)
    wanted = rows
    for weight, bias, _ in network.layers:
        wanted = np.tanh(wanted @ weight.T + bias)
    assert np.allclose(network(rows), np.clip(wanted, -1.0, 1.0), atol=1e-5)
    relu = _network(9, 32, 4, activation="relu", chooses=True)
    wanted = rows
    for weight, bias, _ in relu.layers:
        wanted = np.maximum(wanted @ weight.T + bias, 0.0)
    assert np.array_equal(relu(rows), wanted.argmax(axis=1))


def test_how_many_rows_there_are_changes_nothing_in_one() -> None:
    rows = np.random.default_rng(4).normal(size=(21, 9)).astype(np.float32)
    network = _network(9, 32, 4)
    assert np.array_equal(network(rows), np.concatenate([network(row[None]) for row in rows]))
    assert np.array_equal(network(rows[::2]), network(rows)[::2])


def test_rows_of_another_width_are_refused() -> None:
    with pytest.raises(AgentError, match="9 features, not 8"):
        _network(9, 4)(np.zeros((1, 8), np.float32))
    with pytest.raises(AgentError, match=r"layer 1 has weights of shape \(2, 4\) and 2 biases, for 3 numbers"):
        Network([*_network(9, 3).layers, *_network(4, 2).layers], False)


def test_functions_at_single_precision() -> None:
    for x in (0.0, 1e-30, 1e-7, 0.01, 0.3, 1.0, 5.0, 19.0, 25.0, 1e30, math.inf):
        for value in (x, -x):
            found = narrow.narrow_tanh(value)
            assert math.isclose(found, math.tanh(value), rel_tol=1e-13)
            assert math.copysign(1.0, found) == math.copysign(1.0, value)
        assert math.isclose(narrow.narrow_log1p(x), math.log1p(x), rel_tol=1e-10, abs_tol=1e-15)
    assert math.isnan(narrow.narrow_tanh(math.nan)) and math.isnan(narrow.narrow_log1p(math.nan))


def test_machine_code_gives_the_bits_of_plain_python() -> None:
    x = np.concatenate((np.linspace(0.0, 30.0, 500), [1e-9, 1e6, math.inf, math.nan])).astype(np.float32)
    for kernel in (narrow.tanh_of_all, narrow.log1p_of_all):
        compiled, plain = np.empty_like(x), np.empty_like(x)
        kernel(x, compiled)
        kernel.law(x, plain)
        assert np.array_equal(compiled, plain, equal_nan=True)
