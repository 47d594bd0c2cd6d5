"""The log of a rule: what a script says on stderr, and its traceback if it fails."""

import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO


class Tee:
    """A text stream that writes to two others."""

    def __init__(self, first: TextIO, second: TextIO):
        self.streams = first, second

    def write(self, text: str) -> int:
        for stream in self.streams:
            stream.write(text)
        return len(text)

    def flush(self) -> None:
        for stream in self.streams:
            stream.flush()


@contextmanager
def logged(path: str) -> Iterator[None]:
    """Copy stderr (progress, warnings) to `path` while it still reaches the terminal; a traceback goes there too."""
    terminal = sys.stderr
    with open(path, "w", encoding="utf-8") as log:
        sys.stderr = Tee(terminal, log)
        try:
            yield
        except BaseException:
            traceback.print_exc(file=log)
            raise
        finally:
            sys.stderr = terminal
