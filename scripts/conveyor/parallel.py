"""Independent points in threads: compiled functions release the GIL, and each point writes only its own rows."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from functools import cache
from threading import Lock

from .progress import progress_bar

# Towards the end ranges get shorter: this share of a thread's part of the rest, but at least this share of a chunk.
OF_THE_REST, OF_A_CHUNK = 0.5, 0.03


def ranges_of(count: int, threads: int, chunk: int) -> Iterator[tuple[int, int]]:
    """Consecutive ranges that cover range(count), see `for_each_chunk`."""
    least = max(int(OF_A_CHUNK * chunk), 1)
    begin = 0
    while begin < count:
        left = count - begin
        length = min(max(int(OF_THE_REST * left / threads), least), chunk) if threads > 1 else chunk
        # A short rest belongs to the last range, because a few points may take as long as many.
        end = begin + (left if left - length < least and left <= chunk else min(length, left))
        yield begin, end
        begin = end


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
    progress: str | None = None,
) -> None:
    """Call `work(begin, end)` for consecutive ranges that cover range(count), on `threads` threads.

    Ranges have the length `chunk`; with several threads they get shorter towards the end, so that no thread waits long
    for another one. `work` must write only to its range; then the result depends neither on `threads` nor on `chunk`.
    It may return the number of its points that have failed. An exception in `work` ends the loop and is raised here.
    `progress` is the label of a progress bar on stderr with rate, time left and failed points; None shows no bar.

    Examples
    --------
    >>> squares = np.zeros(5)
    >>> def work(begin, end):
    ...     squares[begin:end] = np.arange(begin, end) ** 2
    >>> for_each_chunk(work, len(squares), threads=2, chunk=2)
    >>> squares.tolist()
    [0.0, 1.0, 4.0, 9.0, 16.0]
    """
    ranges = list(ranges_of(count, threads, chunk))
    # Each thread takes its next range itself; a thread that hands out ranges would cost as much as a few points.
    waiting = iter(ranges)
    lock, failed = Lock(), 0

    with progress_bar(total=count, label=progress) as shown:

        def take() -> None:
            nonlocal failed
            try:
                for begin, end in waiting:
                    failed_here = work(begin, end) or 0
                    with lock:
                        failed += failed_here
                        if failed:
                            shown.set_postfix_str(f"{failed} failed", refresh=False)
                        shown.update(end - begin)
            except BaseException:
                ranges.clear()  # nothing is left for the others
                raise

        futures = [other_threads(threads - 1).submit(take) for _ in range(min(threads, len(ranges)) - 1)]
        try:
            # The calling thread works, too, so that its processor time is all of the time if it is the only thread.
            take()
        finally:
            running = [future for future in futures if not future.cancel()]
            wait(running)
        for future in running:
            future.result()
