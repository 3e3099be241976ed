# SPDX-License-Identifier: BSD-3-Clause
"""Recordings as older versions made them."""

from __future__ import annotations

from pathlib import Path

from sitl.recording.blocks import SECTION, BlockReader, BlockWriter


def without_bits(path: Path) -> None:
    """Take the digests of the flight's bits out of a recording."""
    blocks = list(BlockReader(path))
    writer = BlockWriter(path)
    try:
        for block in blocks:
            if block.kind != SECTION or not block.data.startswith(b"bits\0"):
                writer.write(block.kind, block.data)
    finally:
        writer.close()
