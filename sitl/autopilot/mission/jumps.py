# SPDX-License-Identifier: BSD-3-Clause
"""DO_JUMP and DO_JUMP_TAG: from a number in the mission to the next item that is not a jump.

A tag that is nowhere ends the mission, as a number beyond its end does.

How often each jump was run is kept in the record, so that a snapshot of the vehicle has it.
"""

from __future__ import annotations

from collections.abc import MutableMapping

from ...core.mavlink import MavCmd
from ..navigation.state import Nav
from .mission import Mission

LONGEST = 100
"""So many jumps (or items between two navigation commands) without an end are an endless loop:
there is no next item.
"""
FOREVER = -1


def runs(nav: Nav) -> dict[int, int]:
    """How often each jump was run, by its number."""
    return {int(seq): int(nav.jump_runs[k]) for k, seq in enumerate(nav.jump_item) if seq != 0}


def keep(nav: Nav, counts: MutableMapping[int, int]) -> None:
    """Write the counts to the record;
    jumps beyond the space there is count as run out (as in ``following``).
    """
    nav.jump_item[:] = 0
    nav.jump_runs[:] = 0
    for k, (seq, count) in enumerate(list(counts.items())[: len(nav.jump_item)]):
        nav.jump_item[k], nav.jump_runs[k] = seq, count


def following(
    mission: Mission,
    seq: int,
    counts: MutableMapping[int, int],
    capacity: int,
    taken: list[tuple[int, int, int]] | None = None,
) -> int:
    """Number of the next item from ``seq`` on that is not a jump; 0 at the end or when jumps go in circles.

    ``counts`` is brought up to date; each jump run is appended to ``taken`` as (number, times run, times in
    all). At most ``capacity`` different jumps are counted: a further one is not run.
    """
    for _ in range(LONGEST):
        item = mission.get(seq)
        if item is None:
            return 0
        if item.command not in (MavCmd.DO_JUMP, MavCmd.DO_JUMP_TAG):
            return seq
        target = int(item.p1) if item.command == MavCmd.DO_JUMP else mission.tagged(int(item.p1))
        times, done = int(item.p2), counts.get(seq, 0)
        known = seq in counts or len(counts) < capacity
        if (times == FOREVER or done < times) and known:
            counts[seq] = done if times == FOREVER else done + 1
            if taken is not None:
                taken.append((seq, counts[seq], times))
            seq = target
        else:
            seq += 1
    return 0


def next_nav(mission: Mission, seq: int, counts: MutableMapping[int, int], capacity: int) -> int:
    """Number of the next navigation command from ``seq`` on, passing over do-commands;
    0 when there is none.
    """
    for _ in range(len(mission) + LONGEST):
        seq = following(mission, seq, counts, capacity)
        item = mission.get(seq)
        if item is None or item.is_nav:
            return seq
        seq += 1
    return 0
