"""Processor times of runs that are compared with each other."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import thread_time
from typing import Any

from conveyor.progress import progress_bar

# Shortest turn: a fast run is repeated within it, so that the first repetition with a cold cache does not matter.
TURN = 0.01  # s


def timed(run: Callable[[], Any]) -> tuple[Any, float]:
    """The result of a run and its processor time (s) in this thread."""
    begin = thread_time()
    result = run()
    return result, thread_time() - begin


def run_in_turns(
    runs: Sequence[Callable[[], Any]], *, repeats: int, seconds: float, progress: str | None = None
) -> tuple[list[Any], list[list[float]]]:
    """The results of runs, and the processor times (s) of all their repetitions, in one thread.

    It is not the main thread, from which long runs go to another one, so that Ctrl-C can end them.

    In each of `repeats` rounds, every run has a turn unless `seconds` have been spent on it, so that a slow run is made
    once. Runs take turns, so that other load affects all of them alike. All code must have been compiled before.
    """
    results: list[Any] = [None] * len(runs)
    times: list[list[float]] = [[] for _ in runs]
    with ThreadPoolExecutor(1) as thread:
        for place in progress_bar([*range(len(runs))] * repeats, label=progress, unit="turns"):
            spent = times[place]
            turn_ends = min(sum(spent) + TURN, seconds)
            while sum(spent) < turn_ends:
                results[place], lasted = thread.submit(timed, runs[place]).result()
                spent.append(lasted)
    return results, times
