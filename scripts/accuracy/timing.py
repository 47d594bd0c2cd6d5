"""Processor times of runs of one thread that take turns: they do not need the machine to themselves."""

from collections.abc import Callable, Sequence
from time import thread_time
from typing import Any

from conveyor.solver.progress import bar

# A turn of a fast run lasts so long, so that what ran before it leaves no trace in the median.
TURN = 0.01  # s


def in_turns(
    runs: Sequence[Callable[[], Any]], *, repeats: int, seconds: float, progress: str | None = None
) -> tuple[list[Any], list[list[float]]]:
    """What each run returns, and the processor times (s) of all its repetitions.

    In each of `repeats` rounds every run gets a turn, unless `seconds` have been spent on it: a slow one is made once.
    What has to be compiled must have been before.
    """
    found: list[Any] = [None] * len(runs)
    times: list[list[float]] = [[] for _ in runs]
    for place in bar([*range(len(runs))] * repeats, label=progress, unit="turns"):
        spent = times[place]
        turn_ends = min(sum(spent) + TURN, seconds)
        while sum(spent) < turn_ends:
            begin = thread_time()
            found[place] = runs[place]()
            spent.append(thread_time() - begin)
    return found, times
