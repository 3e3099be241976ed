# SPDX-License-Identifier: BSD-3-Clause
"""TOML and JSON of files that anybody may have written: whatever is wrong with the text is a ``ValueError``.

The standard library raises other errors, too: for lists within lists without end, and (TOML) for a whole number of more
digits than Python takes.
"""

from __future__ import annotations

import json
import tomllib
from typing import Any

_TOO_DEEP = "lists or tables within each other, without end"


def toml(text: str) -> dict[str, Any]:
    """The document of a TOML text.

    Raises:
        tomllib.TOMLDecodeError: it is none.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError:
        raise tomllib.TOMLDecodeError(_TOO_DEEP) from None
    except ValueError as error:
        raise tomllib.TOMLDecodeError(str(error).partition(":")[0]) from None


def of_json(text: str | bytes) -> Any:
    """The value of a JSON text.

    Raises:
        ValueError: it is none.
    """
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError(_TOO_DEEP) from None
