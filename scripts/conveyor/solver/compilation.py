"""What numba compiles in this process: said once on stderr, and timed; nothing if all code comes from the cache.

While it compiles, Python's garbage collector is off: it would search through all that the compiler still needs, and the
first `simulate` would take a tenth longer.

Processes that start together compile each entry (see `jit`) once. One of them holds its lock, looks for its code in the
cache, and compiles what is missing; the others wait and load it. Each entry has a lock of its own, because the entries
of different methods have little code in common; all other functions share one lock.

Numba sends the event "numba:compile" for each function that its cache does not hold, and "numba:compiler_lock" around
each search in the cache with the compilation that may follow (see "Event API" in its documentation).
"""

import gc
import os
import sys
import threading
from functools import cache

from filelock import FileLock
from numba.core import event
from tqdm import tqdm

from . import machine_code

KIND, SEARCH_KIND = "numba:compile", "numba:compiler_lock"
# After this time, s, a process compiles without the lock. The other process may have been suspended.
LONGEST_WAIT = 300.0
OTHERS = "others"  # in place of an entry: the functions outside entries
NOTICE = "Compiling the solver. This happens once per version; later runs load it from the cache."


class Notice(event.Listener):
    """Prints NOTICE when the first function of this library is compiled."""

    shown = False

    def on_start(self, event: event.Event) -> None:
        library = __name__.partition(".")[0]
        if not self.shown and event.data["dispatcher"].py_func.__module__.partition(".")[0] == library:
            self.shown = True
            # On a terminal, above a bar that shows progress.
            write = tqdm.write if sys.stderr.isatty() else print
            write(NOTICE, file=sys.stderr)

    def on_end(self, event: event.Event) -> None:
        pass


class WithoutCollector(event.Listener):
    """Keeps the garbage collector off, if it is on, from the first to the last of nested compilations."""

    depth, was_on = 0, False

    def on_start(self, event: event.Event) -> None:
        if self.depth == 0:
            self.was_on = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event: event.Event) -> None:
        self.depth -= 1
        if self.depth == 0 and self.was_on:
            gc.enable()


@cache
def lock_of(process: int, entry: str) -> FileLock:
    """The lock of an entry or of OTHERS, which all threads of a process share; a forked process needs its own."""
    file = machine_code.root() / f"compiling-{entry}.lock"
    return FileLock(file, timeout=LONGEST_WAIT, thread_local=False, fallback_to_soft=False)


class OneProcess(event.Listener):
    """Holds a lock from the first to the last of nested searches in the cache. A killed process releases it."""

    threads = threading.local()  # `entry` is the one that the thread calls

    def on_start(self, event: event.Event) -> None:
        depth = getattr(self.threads, "depth", 0)
        if depth == 0:
            self.threads.lock = lock_of(os.getpid(), getattr(self.threads, "entry", OTHERS))
            try:
                self.threads.lock.acquire()
            except (OSError, NotImplementedError):  # too late, or a file system without locks
                self.threads.lock.timeout = 0.0
        self.threads.depth = depth + 1

    def on_end(self, event: event.Event) -> None:
        self.threads.depth -= 1
        if self.threads.depth == 0:
            self.threads.lock.release()


TIMER = event.TimingListener()
event.register(SEARCH_KIND, OneProcess())
event.register(KIND, Notice())
event.register(KIND, WithoutCollector())
event.register(KIND, TIMER)


def compile_seconds() -> float:
    """Seconds that this process has spent compiling; 0 if all machine code came from the cache."""
    return TIMER.duration if TIMER.done else 0.0
