# SPDX-License-Identifier: BSD-3-Clause
"""Files that are whole or not there: written beside the old one, then put in its place."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core.array_files import MIB, ArrayFileError, read_file, read_npz
from sitl.core.whole_file import write_whole

from ..errors import AgentError

MOST_TABLE = 1024 * MIB
"""Memory that the arrays of a file may take [bytes]."""


def make_folder(path: Path) -> None:
    """Make a folder, and those above it, where it is not there yet.

    Raises:
        AgentError: it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise AgentError(f"{path} cannot be made: {error.strerror}") from None


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file atomically.

    Raises:
        AgentError: it cannot be written.
    """
    write_whole(path, content, AgentError)


def write_json(path: Path, value: Any) -> None:
    """Write JSON atomically, indented."""
    write_bytes(path, (json.dumps(value, indent=2) + "\n").encode())


def write_arrays(path: Path, arrays: Mapping[str, npt.NDArray[Any]]) -> None:
    """Write named arrays atomically as .npz."""
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)  # type: ignore[arg-type]
    write_bytes(path, content.getvalue())


def read_arrays(path: Path) -> dict[str, npt.NDArray[Any]]:
    """Read the arrays that ``write_arrays`` wrote.

    Raises:
        AgentError: there is no such file, or it is something else, or larger than ``MOST_TABLE``.
    """
    try:
        return read_npz(read_file(path, MOST_TABLE), MOST_TABLE)
    except FileNotFoundError:
        raise AgentError(f"there is no model {path}") from None
    except OSError as error:
        raise AgentError(f"{path} cannot be read: {error.strerror or error}") from None
    except ArrayFileError as error:
        raise AgentError(f"{path} is no model: {error}") from None
