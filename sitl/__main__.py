# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command, and ``python -m sitl``."""

import os
import signal
import sys
from typing import Any


def main() -> int:
    """Load and run the command. Ctrl-C while it is being loaded ends it as later does: exit code 130, no traceback."""
    heeds = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if heeds:  # in the background of a shell it is ignored, and stays so
        signal.signal(signal.SIGINT, _leave)
    from .cli import main as command

    if heeds:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return command()


def _leave(*_: Any) -> None:
    os._exit(130)  # nothing was begun that must be ended


if __name__ == "__main__":
    sys.exit(main())
