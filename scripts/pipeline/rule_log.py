"""The log of a rule: what a script says on stderr, and its traceback if it fails."""

import sys
import traceback
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import TextIO


class Tee:
    """A text stream that writes to a terminal and to a log, which has the last look of a bar that draws over itself."""

    def __init__(self, terminal: TextIO, log: TextIO):
        self.terminal, self.log = terminal, log
        self.line = ""

    def isatty(self) -> bool:
        return self.terminal.isatty()

    def write(self, text: str) -> int:
        self.terminal.write(text)
        *lines, self.line = (self.line + text).split("\n")
        self.log.writelines(f"{last_look(line)}\n" for line in lines)
        return len(text)

    def flush(self) -> None:
        self.terminal.flush()
        self.log.flush()

    def close(self) -> None:
        """Write what has not ended its line to the log; the terminal stays open."""
        self.log.write(last_look(self.line))


def last_look(line: str) -> str:
    """What a terminal shows of a line in the end."""
    return line.rpartition("\r")[2]


@contextmanager
def logged(path: str) -> Iterator[None]:
    """Copy stderr (progress, warnings) to `path` while it still reaches the terminal; a traceback goes there too."""
    terminal = sys.stderr
    with open(path, "w", encoding="utf-8") as log, closing(Tee(terminal, log)) as both:
        sys.stderr = both
        try:
            yield
        except BaseException:
            traceback.print_exc(file=both.log)
            raise
        finally:
            sys.stderr = terminal
