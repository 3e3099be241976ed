# SPDX-License-Identifier: BSD-3-Clause
"""``python -m sitl``: the same as the ``sitl`` command."""

import sys

from .cli import main

sys.exit(main())
