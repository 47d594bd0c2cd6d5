"""Independent points in threads: compiled functions release the GIL, and each point writes only its own rows."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from functools import cache
from threading import Lock

from .progress import bar

# Towards the end ranges get shorter: this share of what is left for each thread, but not below this one of a chunk.
OF_THE_REST, OF_A_CHUNK = 0.5, 0.03


def ranges_of(count: int, threads: int, chunk: int) -> Iterator[tuple[int, int]]:
    """Consecutive ranges that cover range(count), see `for_each_chunk`."""
    least = max(int(OF_A_CHUNK * chunk), 1)
    begin = 0
    while begin < count:
        left = count - begin
        length = min(max(int(OF_THE_REST * left / threads), least), chunk) if threads > 1 else chunk
        # What would be left alone belongs to the last one: a few points may cost as much as many.
        end = begin + (left if left - length < least and left <= chunk else min(length, left))
        yield begin, end
        begin = end


@cache
def other_threads(count: int) -> ThreadPoolExecutor:
    """Threads that wait for work as long as the process lasts: one that begins may share a processor for milliseconds.

    What none of them comes to, as they are busy or left behind by a fork, the one that asks does itself.
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

    Ranges have the length `chunk`; those of several threads get shorter towards the end, so that none waits long for
    another. `work` must write only what belongs to its range, so that the result depends neither on `threads` nor on
    `chunk`; it may return how many of its points have failed. An exception in it ends the loop and is raised here.
    `progress` names what is shown on stderr: rate, time left and failed points; None shows nothing.
    """
    ranges = list(ranges_of(count, threads, chunk))
    # Every thread takes the next range by itself: to be given each by one of them would cost as much as a few points.
    waiting = iter(ranges)
    at_a_time, failed = Lock(), 0

    with bar(total=count, label=progress) as shown:

        def take() -> None:
            nonlocal failed
            try:
                for begin, end in waiting:
                    of_them = work(begin, end) or 0
                    with at_a_time:
                        failed += of_them
                        if failed:
                            shown.set_postfix_str(f"{failed} failed", refresh=False)
                        shown.update(end - begin)
            except BaseException:
                ranges.clear()  # nothing is left for the others
                raise

        asked = [other_threads(threads - 1).submit(take) for _ in range(min(threads, len(ranges)) - 1)]
        try:
            # The present thread works, too: who asks for its processor time gets it all where it is the only one.
            take()
        finally:
            begun = [one for one in asked if not one.cancel()]
            wait(begun)
        for one in begun:
            one.result()
