# SPDX-License-Identifier: BSD-3-Clause
"""A learnt network as one small file: its weights, and what somebody who plays it has to know.

The file is an .npz that NumPy alone reads: ``weight0``, ``bias0``, ``weight1``, ... as float32, and ``about``, JSON in
UTF-8 bytes. It holds no pickles, so that somebody else's file can be opened.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sitl.core import documents
from sitl.core.array_files import MIB, read_file, read_npz

from ..errors import AgentError
from ..runs.files import write_bytes
from .actions import Actions
from .features import Features
from .network import ACTIVATIONS, Layer, Network
from .policy import DeepPolicy
from .settings import settings_of
from .spaces import described, space_of

SUFFIX = ".npz"
FORMAT = 1
MOST = 64 * MIB
"""Length of a file, and memory that its arrays may take [bytes]: those that come with the package have 0.1 MiB."""


def write(path: Path, policy: DeepPolicy, about: Mapping[str, Any]) -> None:
    """Write a policy, whole or not at all.

    Args:
        path: of the file.
        policy: what is written.
        about: what else is kept, of JSON types: environment, options, time of a step, versions.

    Raises:
        AgentError: it cannot be written.
    """
    arrays: dict[str, Any] = {}
    for k, layer in enumerate(policy.network.layers):
        arrays[f"weight{k}"], arrays[f"bias{k}"] = layer.weight, layer.bias
    own = {
        "format": FORMAT,
        **about,
        "activations": [layer.activation for layer in policy.network.layers],
        "sectors": policy.settings.sectors,
        "frames": policy.settings.frames,
        "observations": described(policy.features.space),
        "actions": described(policy.actions.environment),
    }
    arrays["about"] = np.frombuffer(json.dumps(own).encode(), np.uint8)
    content = io.BytesIO()
    np.savez(content, **arrays)
    write_bytes(path, content.getvalue())


def read(path: Path) -> tuple[dict[str, Any], DeepPolicy]:
    """What is kept beside a policy, and the policy.

    Raises:
        AgentError: there is no such file, or it is none of a policy.
    """
    try:
        arrays = read_npz(read_file(path, MOST), MOST)
        if "about" not in arrays:
            raise ValueError("it has no 'about'")
        about = documents.of_json(bytes(arrays["about"]))
        if about["format"] != FORMAT:
            raise AgentError(f"{path} has format {about['format']!r}; this version reads {FORMAT}")
        layers = [
            Layer(arrays[f"weight{k}"], arrays[f"bias{k}"], activation)
            for k, activation in enumerate(about["activations"])
        ]
        return about, _policy(about, layers)
    except OSError as error:
        raise AgentError(f"{path} cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, IndexError, OverflowError) as error:
        raise AgentError(f"{path} is no file of a policy: {error}") from None


def _policy(about: dict[str, Any], layers: list[Layer]) -> DeepPolicy:
    """Raises ValueError, KeyError or TypeError when the parts do not fit."""
    algorithm = about["algorithm"]
    settings = settings_of(algorithm, {"sectors": about["sectors"], "frames": about["frames"]})
    features = Features(space_of(about["observations"]), settings.sectors)
    actions = Actions(space_of(about["actions"]), algorithm)
    width = features.width * settings.frames
    for k, (weight, bias, activation) in enumerate(layers):
        fits = weight.dtype == bias.dtype == np.float32 and weight.ndim == 2 and weight.shape[1] == width
        if not fits or bias.shape != weight.shape[:1] or activation not in ACTIVATIONS:
            raise ValueError(f"layer {k}: {weight.dtype} {weight.shape}, {bias.shape}, {activation!r}")
        if not (np.isfinite(weight).all() and np.isfinite(bias).all()):
            raise ValueError(f"layer {k} has numbers that are not finite")
        width = len(bias)
    moves: Any = actions.space
    wanted = int(moves.n) if hasattr(moves, "n") else int(np.prod(moves.shape))
    if width != wanted:
        raise ValueError(f"{width} outputs; {moves} needs {wanted}")
    return DeepPolicy(Network(layers, hasattr(moves, "n")), settings, features, actions)
