# SPDX-License-Identifier: BSD-3-Clause
"""Rows of numbers of a vehicle's record, taken at regular times while the core runs: what a log is made of."""

from __future__ import annotations

from ..core.constants import NEVER
from ..core.kernels import law
from ..core.memory import ints_at, record_at
from ..core.records import Ints, Record, array

LONGEST_US = 100_000
"""Longest time between two rows [us]."""
PERIODS = 8


class Sampler(Record):
    """What is taken of one vehicle, and when. Who owns it keeps the arrays in place."""

    due_us: int  # when the next row is taken [since boot]
    row_us: int  # when the last one was [since boot]
    row: int  # number of the last one; row 0 is there from the start
    rows: int  # number of the last one that there is space for
    period_count: int
    period_us: Ints = array(PERIODS, stored="i8")  # a row is taken at each multiple of each
    count: int  # words of 8 bytes in a row
    words: int  # address of their offsets in the vehicle's record, in words
    source: int  # address of the vehicle's record
    source_words: int
    to: int  # address of row 0


@law
def next_row_us(sampler: Sampler, now_us: int) -> int:
    """When a row is due after ``now_us`` [since boot]."""
    due = now_us + LONGEST_US
    for k in range(sampler.period_count):
        period = sampler.period_us[k]
        due = min(due, (now_us // period + 1) * period)
    return due


@law
def row_due(address: int) -> int:
    """When the core has to take the next row of the sampler at ``address`` [us since boot]; 0 is no sampler."""
    return record_at(Sampler, address).due_us if address != 0 else NEVER


@law
def take_row(address: int, now_us: int) -> bool:
    """Take a row at ``now_us``; False: there is no space for another one after it."""
    sampler = record_at(Sampler, address)
    count = sampler.count
    words, source = ints_at(sampler.words, count), ints_at(sampler.source, sampler.source_words)
    sampler.row += 1
    to = ints_at(sampler.to + 8 * count * sampler.row, count)
    for k in range(count):
        to[k] = source[words[k]]
    sampler.row_us = now_us
    sampler.due_us = next_row_us(sampler, now_us)
    return sampler.row < sampler.rows
