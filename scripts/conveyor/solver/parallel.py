"""Many independent points in threads: compiled kernels release the GIL, each point writes only its own rows."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed

from .progress import bar


def for_each_chunk(
    work: Callable[[int, int], int | None],
    count: int,
    *,
    threads: int = 1,
    chunk: int = 64,
    progress: str | None = None,
) -> None:
    """Call `work(begin, end)` for consecutive ranges that cover range(count), on `threads` threads.

    `work` must write only what belongs to its range, so that the result depends neither on `threads` nor on `chunk`; it
    may return how many of its points have failed. An exception in it ends the loop and is raised here. `progress` names
    what is shown on stderr: rate, time left and failed points; None shows nothing.
    """
    ranges = [(begin, min(begin + chunk, count)) for begin in range(0, count, chunk)]

    def done() -> Iterator[tuple[int, int]]:
        """Number of points, and of those that have failed, of each range."""
        if threads == 1 or len(ranges) == 1:
            # Not in a thread of its own: who asks for the processor time of the present one gets it all.
            yield from ((end - begin, work(begin, end) or 0) for begin, end in ranges)
            return
        with ThreadPoolExecutor(threads) as pool:
            futures = {pool.submit(work, begin, end): end - begin for begin, end in ranges}
            try:
                yield from ((futures[future], future.result() or 0) for future in as_completed(futures))
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise

    failed = 0
    with bar(total=count, label=progress) as shown:
        for points, of_them in done():
            failed += of_them
            if failed:
                shown.set_postfix_str(f"{failed} failed", refresh=False)
            shown.update(points)
