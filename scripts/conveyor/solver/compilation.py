"""What numba compiles in this process: said once on stderr, and timed; nothing if all code comes from the cache.

While it compiles, Python's garbage collector is off: it would search through all that the compiler still needs, and the
first `simulate` would take a tenth longer.

Numba sends the event "numba:compile" for each function that its cache does not hold (see "Event API" in its
documentation).
"""

import gc
import sys

from numba.core import event
from tqdm import tqdm

KIND = "numba:compile"
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


TIMER = event.TimingListener()
event.register(KIND, Notice())
event.register(KIND, WithoutCollector())
event.register(KIND, TIMER)


def compile_seconds() -> float:
    """Seconds that this process has spent compiling; 0 if all machine code came from the cache."""
    return TIMER.duration if TIMER.done else 0.0
