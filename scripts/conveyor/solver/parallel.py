"""Many independent points in threads: compiled kernels release the GIL, each point writes only its own rows."""

import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed

from tqdm import tqdm


def for_each_chunk(
    work: Callable[[int, int], None], count: int, *, threads: int = 1, chunk: int = 64, progress: str | None = None
) -> None:
    """Call `work(begin, end)` for consecutive ranges that cover range(count), on `threads` threads.

    `work` must write only what belongs to its range, so that the result depends neither on `threads` nor on `chunk`.
    An exception in it ends the loop and is raised here. `progress` names a progress bar on stderr; None shows none.
    """
    ranges = [(begin, min(begin + chunk, count)) for begin in range(0, count, chunk)]
    with (
        tqdm(
            total=count, desc=progress, unit="point", disable=progress is None, file=sys.stderr, mininterval=1.0
        ) as bar,
        ThreadPoolExecutor(threads) as pool,
    ):
        futures = {pool.submit(work, begin, end): end - begin for begin, end in ranges}
        try:
            for future in as_completed(futures):
                future.result()
                bar.update(futures[future])
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
