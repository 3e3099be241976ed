# SPDX-License-Identifier: BSD-3-Clause
"""What one channel sends regularly, and when the next of it is due."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from .dialect import MessageType

NEVER = 1 << 62
"""A time that does not come [us]."""

Entry = tuple[MessageType, Callable[[], bytes | tuple[bytes, ...]]]
Layout = tuple[tuple[int, tuple[int, ...]], ...]
"""(interval [us], numbers of the messages sent at it), in the order in which they were asked for."""


class _Bucket:
    """Messages with the same interval: they go out together, on whole multiples of it since boot."""

    __slots__ = ("entries", "interval_us", "next_us")

    def __init__(self, interval_us: int, now_us: int) -> None:
        self.interval_us = interval_us
        self.next_us = (now_us // interval_us + 1) * interval_us
        self.entries: dict[int, Entry] = {}


class StreamTable:
    """Intervals by message.

    Equal intervals fall on equal times, so that the simulation is interrupted as seldom as possible.
    """

    def __init__(self) -> None:
        self._buckets: dict[int, _Bucket] = {}
        self._interval: dict[int, int] = {}
        self._layout: Layout | None = ()
        self._in_order: list[_Bucket] = []
        self.next_us = NEVER

    def interval(self, number: int) -> int:
        """Interval of a message [us], 0 when it is not sent."""
        return self._interval.get(number, 0)

    def set(self, entry: Entry, interval_us: int, now_us: int) -> None:
        """Send ``entry`` every ``interval_us``, beginning at the next whole multiple; 0 stops it."""
        number = entry[0].id
        self._layout = None
        old = self._interval.get(number, 0)
        if old == interval_us:
            return
        if old:
            bucket = self._buckets[old]
            del bucket.entries[number], self._interval[number]
            if not bucket.entries:
                del self._buckets[old]
        if interval_us:
            if interval_us not in self._buckets:
                self._buckets[interval_us] = _Bucket(interval_us, now_us)
            self._buckets[interval_us].entries[number] = entry
            self._interval[number] = interval_us
        self._find_next()

    def snapshot(self) -> Layout:
        """What is sent at which interval; when it is due follows from the time."""
        if self._layout is None:
            self._layout = tuple((interval, tuple(b.entries)) for interval, b in self._buckets.items())
        return self._layout

    def restore(self, layout: Layout | None, entries: Mapping[int, Entry], now_us: int) -> None:
        """Time was set to ``now_us``.

        Everything is due at its next whole multiple from there; ``layout`` replaces what is sent (None: keep).
        """
        if layout is not None and layout is not self._layout:
            self._interval = {number: interval for interval, numbers in layout for number in numbers}
            self._buckets = {interval: _Bucket(interval, now_us) for interval, _ in layout}
            for interval, numbers in layout:
                self._buckets[interval].entries = {number: entries[number] for number in numbers}
            self._layout = layout
        for bucket in self._buckets.values():
            bucket.next_us = (now_us // bucket.interval_us + 1) * bucket.interval_us
        self._find_next()

    def _find_next(self) -> None:
        self._in_order = [self._buckets[interval] for interval in sorted(self._buckets)]
        self.next_us = min((bucket.next_us for bucket in self._in_order), default=NEVER)

    def take_due(self, now_us: int) -> list[Entry]:
        """All messages due by ``now_us``, in order of interval, then number of request.

        Each once, however late it is.
        """
        due: list[Entry] = []
        later = NEVER
        for bucket in self._in_order:
            if bucket.next_us <= now_us:
                due.extend(bucket.entries.values())
                bucket.next_us = (now_us // bucket.interval_us + 1) * bucket.interval_us
            if bucket.next_us < later:
                later = bucket.next_us
        self.next_us = later
        return due
