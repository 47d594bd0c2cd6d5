"""Independent points in threads: compiled functions release the GIL, and each point writes only its own rows."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from functools import cache
from typing import TypeVar

from tqdm import tqdm

from .progress import progress_bar

Result = TypeVar("Result")
# What stops the long work of a call of `for_each_chunk`, for its threads.
of_thread = threading.local()

# The first range of a thread is this share of a chunk. Each following one grows by at most GROWTH, and takes about
# SECONDS, so that Ctrl-C and progress bars do not wait for long.
FIRST, GROWTH, SECONDS = 1.0 / 512.0, 4.0, 1.0
# Towards the end ranges get shorter: this share of a thread's part of the rest, but at least this share of a chunk.
OF_THE_REST, OF_A_CHUNK = 0.5, 0.03


def next_length(points: int, threads: int, chunk: int, length: int, seconds: float) -> int:
    """The length of a thread's next range, of `points` that remain, after one of a `length` that took some seconds."""
    least = max(int(OF_A_CHUNK * chunk), 1)
    if length == 0:
        wanted = max(int(FIRST * chunk), 1)
    else:
        wanted = min(max(int(length * min(GROWTH, SECONDS / max(seconds, 1e-9))), 1), chunk)
    if threads > 1:
        wanted = min(wanted, max(int(OF_THE_REST * points / threads), least))
    # A short rest belongs to the last range, because a few points may take as long as many.
    return points if points <= wanted or (points - wanted < least and points <= chunk and wanted >= least) else wanted


@cache
def other_threads(count: int) -> ThreadPoolExecutor:
    """Threads that wait for work as long as the process lasts, because a new thread takes milliseconds to get a core.

    If they are busy, or were lost in a fork, the calling thread does all the work.
    """
    return ThreadPoolExecutor(count)


def for_each_chunk(
    work: Callable[[int, int], int | None],
    count: int,
    *,
    threads: int = 1,
    chunk: int = 64,
    progress: str | tqdm | None = None,
) -> None:
    """Call `work(begin, end)` for consecutive ranges that cover range(count), on `threads` threads.

    Ranges have at most the length `chunk`, and take about a second; with several threads they get shorter towards
    the end, so that no thread waits long for another one. `work` must write only to its range; then the result depends
    neither on `threads` nor on `chunk`. It may return the number of its points that have failed. An exception in `work`
    ends the loop and is raised here. `progress` is the label of a progress bar on stderr with rate, time left and
    failed points, or an open bar; None shows no bar.

    Examples
    --------
    >>> squares = np.zeros(5)
    >>> def work(begin, end):
    ...     squares[begin:end] = np.arange(begin, end) ** 2
    >>> for_each_chunk(work, len(squares), threads=2, chunk=2)
    >>> squares.tolist()
    [0.0, 1.0, 4.0, 9.0, 16.0]
    """
    lock, begun, failed, stops = threading.Lock(), 0, 0, set()

    with progress_bar(total=count, label=progress) as shown:
        # Each thread takes its next range itself; a thread that hands out ranges would cost as much as a few points.
        def take() -> None:
            nonlocal begun, failed
            length, seconds = 0, 0.0
            outer, of_thread.stops = getattr(of_thread, "stops", set()), stops
            try:
                while True:
                    with lock:
                        if begun >= count:
                            return
                        length = next_length(count - begun, threads, chunk, length, seconds)
                        begin = begun
                        begun += length
                    started = time.perf_counter()
                    failed_here = work(begin, begin + length) or 0
                    seconds = time.perf_counter() - started
                    with lock:
                        failed += failed_here
                        if failed:
                            shown.set_postfix_str(f"{failed} failed", refresh=False)
                        shown.update(length)
            except BaseException:
                end()
                raise
            finally:
                of_thread.stops = outer

        def end() -> None:
            nonlocal begun
            begun = count  # nothing is left for the others
            for stop in tuple(stops):
                stop()

        futures = [other_threads(threads - 1).submit(take) for _ in range(min(threads, count) - 1)]
        try:
            # The calling thread works, too, so that its processor time is all of the time if it is the only thread.
            take()
        finally:
            running = [future for future in futures if not future.cancel()]
            try:
                wait(running)
            except BaseException:
                end()
                raise
        for future in running:
            future.result()


def call_interruptibly(work: Callable[[], Result], stop: Callable[[], None], *, is_long: bool) -> Result:
    """The result of `work`; if it `is_long`, Ctrl-C calls `stop`, after which `work` must end soon.

    Python handles Ctrl-C in the main thread, between its own steps. Long compiled work of the main thread therefore
    goes to another thread, which costs a tenth of a millisecond. In a thread of `for_each_chunk`, an error in another
    of its threads calls `stop`, too.
    """
    if not is_long:
        return work()
    if threading.current_thread() is not threading.main_thread():
        stops = getattr(of_thread, "stops", set())
        stops.add(stop)
        try:
            return work()
        finally:
            stops.discard(stop)
    with ThreadPoolExecutor(1) as thread:
        future = thread.submit(work)
        try:
            while not future.done():
                wait([future], timeout=0.1)
        except BaseException:
            stop()
            raise
        return future.result()
