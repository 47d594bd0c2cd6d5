"""Progress of long work on stderr: a bar on a terminal, else a line from time to time."""

import math
import sys
from contextlib import AbstractContextManager, nullcontext
from typing import TextIO

from tqdm import tqdm

SECONDS = 1.0  # between two updates of a bar
SECONDS_OF_LINES = 60.0  # between two lines
LINE = "{desc}: {n_fmt} of {total_fmt}{unit}, {rate_noinv_fmt}, {elapsed} gone, {remaining} left{postfix}"


class Lines(tqdm):
    """Lines in place of a bar: one every SECONDS_OF_LINES, and a last one."""

    @staticmethod
    def status_printer(file: TextIO):
        def print_line(text: str) -> None:
            if text:
                file.write(f"{text}\n")
                file.flush()

        return print_line

    shown = 0  # units at the last line

    def display(self, msg=None, pos=None) -> bool:
        if self.n == self.shown:
            return False
        self.shown = self.n
        return super().display(msg, pos)

    def close(self) -> None:
        if not self.disable:
            self.display()
            self.delay = math.inf  # otherwise tqdm adds an empty line
        super().close()


def progress_bar(
    items=None, *, total: int | None = None, label: str | tqdm | None, unit: str = "points"
) -> tqdm | AbstractContextManager[tqdm]:
    """Progress over `items`, or over `total` units that `update` counts; nothing is shown without a label.

    An open bar in place of a label counts these units, too, and stays open. Work that consists of several parts thus
    shows one bar.

    Examples
    --------
    >>> [2 * number for number in progress_bar([1, 2, 3], label=None)]
    [2, 4, 6]
    """
    if isinstance(label, tqdm):
        return nullcontext(label)
    if not isinstance(label, str | None):
        raise TypeError(f"progress = {label!r} must be the label of the bar, a str, or None")
    options = {"desc": label, "unit": f" {unit}", "disable": label is None, "file": sys.stderr}
    if sys.stderr.isatty():
        return tqdm(items, total=total, mininterval=SECONDS, dynamic_ncols=True, **options)
    return Lines(
        items, total=total, mininterval=SECONDS_OF_LINES, maxinterval=SECONDS_OF_LINES, bar_format=LINE, **options
    )
