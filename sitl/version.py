# SPDX-License-Identifier: BSD-3-Clause
"""The version of this package. ``sitl.__version__`` offers it; every package may read it here."""

__version__ = "0.2.0.dev0"
