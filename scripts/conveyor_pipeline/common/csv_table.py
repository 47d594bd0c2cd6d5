"""Tables of measured numbers in text files as loggers and spreadsheets write them: find the header, separator and signs
of the numbers, and name what is wrong with the text, by file and line.

The Snakefile imports this module to check files before any job starts, so pandas is imported when there is a file.
"""

import csv
import gzip
import io
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

MOST_FAULTS = 5  # that a message names
DELETE = "delete the line"
SAMPLED = 300  # lines that show how a file separates its columns
PREAMBLE = 200  # lines among which the header is searched
SURELY_THOUSANDS = 50  # numbers of a column
SEPARATORS = (";", "\t", ",", " ")
NUMBER = re.compile(r"[-+]?(\d[\d.,'\u00a0\u202f]*|[.,]\d+)([eE][-+]?\d+)?")
# A clock time, also behind a date of any form, or of minutes and seconds alone; some write 12:30:05:250, and AM or PM.
CLOCK = re.compile(
    r"(?:(?:(?P<date>[-\w./ ]{6,11})[T ])?(?P<hours>\d{1,2}):)?(?P<minutes>\d{1,2}):(?P<seconds>\d{2}(?:[.,:]\d+)?)"
    r"(?: ?(?P<half>[AP]M))?(?: ?(?:Z|UTC|GMT|(?P<offset>[-+]\d{2}(?::?\d{2})?)))?",
    re.IGNORECASE,
)
# A unit behind a name: Time (ms), accel [g], and in a line of its own: (s), m/s^2; and as in DIN 461: t/ms.
UNIT = re.compile(r"\s*/?\s*[(\[<{]([^()\[\]<>{}]*)[)\]>}]$")
RATIO = re.compile(r"([^/\s]+)\s*/\s*(\S+)")
RESTART = 10.0  # intervals by which a time goes back where another run begins
ANOTHER_RUN = "another run, or an overflow of the clock, begins there; keep the lines of one run"
HOUR, DAY = 3600.0, 86_400.0  # s
EXCEL_LINE = re.compile(r'"?sep=."?')


class TableError(ValueError):
    """A file that cannot be used: one line for each fault, with file, line number and remedy."""

    def __init__(self, faults: list[str]):
        self.faults = faults
        super().__init__("\n".join(faults))


class Table(NamedTuple):
    """The fields of a text file."""

    path: str
    header: int  # line of the file
    names: list[str]  # of the columns, without units
    units: list[str]  # of the columns; empty if not stated
    lines: Any  # line of the file for each row, array of shape (n,)
    fields: Any  # data frame of texts, one column for each name, n rows
    signs: tuple[str, str]  # decimal sign, and the sign between thousands (may be empty)

    def error(self, faults: Iterable[tuple[int | None, str]]) -> TableError:
        """The error that names faults, each with its line (None: the whole file)."""
        return TableError([f"{self.path}{'' if line is None else f':{line}'}: {fault}" for line, fault in faults])

    def numbers(self, place: int, name: str, remedy: str = DELETE) -> tuple[Any, list[tuple[int, str]]]:
        """The numbers in a column as an array, and line and description of each text that is no number; `remedy` says
        what to do with a line without a number."""
        import numpy as np

        values = to_numbers(self.fields[place], self.signs)
        wrong = np.flatnonzero(~np.isfinite(values))
        return values, [(int(self.lines[row]), number_fault(name, self.fields[place][row], remedy)) for row in wrong]

    def seconds(self, place: int, scale: float) -> tuple[Any, list[tuple[int, str]]]:
        """Times (s) from the first one on, from numbers in units of `scale` s, clock times or ISO dates; and faults."""
        import numpy as np

        texts = self.fields[place]
        if texts.str.contains(":", regex=False).mean() > 0.5:
            time = clock_seconds(texts)
        else:
            numbers, _ = self.numbers(place, "time")
            time = (numbers - (numbers[0] if len(numbers) and np.isfinite(numbers[0]) else 0)) * scale
        wrong = np.flatnonzero(~np.isfinite(time))
        faults = [(int(self.lines[row]), number_fault("time", texts[row], DELETE)) for row in wrong]
        back = np.flatnonzero(np.diff(time) < 0.0) + 1
        remedy = remedy_of_order(time)
        if remedy:  # once, because all lines have the same cause
            back = back[:1]
        if not remedy:
            remedy = "sort the lines, or state excitation.rate (Hz) in place of the times"
        elif remedy == ANOTHER_RUN:
            remedy += ", or state excitation.rate (Hz) if it overflows"
        for row in back:
            faults.append((int(self.lines[row]), f"time = {texts[row]} is earlier than the line before; {remedy}"))
        return time, faults


def remedy_of_order(time: Any) -> str:
    """The remedy for times (s) of lines that are in reverse order, or of several runs; empty for other times."""
    import numpy as np

    steps = np.diff(time)
    if np.count_nonzero(steps < 0.0) > np.count_nonzero(steps > 0.0):
        return "the last lines come first; reverse their order"
    back = np.flatnonzero(steps < 0.0)
    apart = RESTART * float(np.median(np.abs(steps))) if len(steps) else 0.0
    begins = time[back + 1] <= np.minimum.accumulate(time)[back] + apart
    if len(back) and begins.all() and 0.0 < apart < -steps[back].max():
        return ANOTHER_RUN
    return ""


def decode(content: bytes, path: str | Path = "") -> str:
    """The text of a file: UTF-8, UTF-16 with a mark, or Latin-1, also compressed by gzip."""
    try:
        content = gzip.decompress(content) if content.startswith(b"\x1f\x8b") else content
    except (OSError, EOFError) as error:
        raise TableError([f"{path}: cannot be unpacked ({error}); compress it again"]) from error
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def read_text(path: str | Path, key: str, most_bytes: int) -> str:
    """The text of the file that a key of the config names; TableError says why it cannot be read."""
    try:
        if Path(path).stat().st_size > most_bytes:
            raise TableError([f"{path}: is larger than {most_bytes:,} bytes; keep a piece of the file"])
        text = decode(Path(path).read_bytes(), path)
    except OSError as error:
        remedy = f"{key} names a CSV file, relative to its overlay, or else to the working directory"
        raise TableError([f"{path}: {error.strerror}; {remedy}"]) from error
    if "\x00" in text or text.startswith("PK\x03\x04"):
        raise TableError([f"{path}:1: is not text; export the table as CSV"])
    return text


def split(line: str, separator: str) -> list[str]:
    """The fields of a line."""
    if separator == " ":
        return next(csv.reader([re.sub(r"\s+", " ", line.strip())], delimiter=" "))
    return [
        field.strip() for field in next(csv.reader([line.strip(" \r")], delimiter=separator, skipinitialspace=True))
    ]


def is_value(field: str) -> bool:
    """Whether a field is a number, a date or a time."""
    return bool(NUMBER.fullmatch(field) or CLOCK.fullmatch(field))


def values_in(line: str, separator: str) -> int:
    """The number of fields that are values, 0 if it is less than two."""
    count = sum(map(is_value, split(line, separator)))
    return count if count > 1 else 0


def separator_of(lines: Sequence[str]) -> str:
    """The separator with which most lines hold values; of two, the one that leaves fewer other texts, then any but a
    space, which also stands within names and behind commas, and then the more frequent one in the first line."""
    sampled = lines[:: max(1, len(lines) // SAMPLED)]

    def score(separator: str) -> tuple[int, int, bool, int]:
        rows = [line for line in sampled if values_in(line, separator)]
        fields = [field for line in rows for field in split(line, separator) if field]
        texts = sum(not is_value(field) or field[-1] in ",;" for field in fields)
        return len(rows), -texts, separator != " ", lines[0].count(separator)

    return max(SEPARATORS, key=score)


def name_and_unit(header: str, units: Iterable[str]) -> tuple[str, str]:
    """The name of a column and its unit: `Time (ms)` is `Time` in `ms`."""
    name = header.strip().lstrip("#").strip()
    if (ratio := RATIO.fullmatch(name)) and ratio[2] in units:
        return ratio[1], ratio[2]
    unit = UNIT.search(name)
    return (name[: unit.start()].strip(), unit[1].strip()) if unit and unit.start() else (name, "")


def is_unit_line(fields: list[str], units: Iterable[str]) -> bool:
    """Whether a line beside a header states units: none of its texts is a value, and at least two are known."""
    known = sum(bool(UNIT.fullmatch(field) or field in units) for field in fields)
    return known == len(list(filter(None, fields))) > 0 or (known > 1 and not any(map(is_value, fields)))


def find_header(lines: Sequence[tuple[int, str]], separator: str, is_known: Callable[[str], bool]) -> int | None:
    """The place of the line above the values that names most known columns, or else of the last line of several names.

    A commented line counts if no other line names a column.
    """
    # Two lines in succession: a line of settings before the header may hold numbers, too.
    following = zip(lines, [*lines[1:], lines[-1]], strict=True)
    first = next(
        (place for place, pair in enumerate(following) if all(values_in(line, separator) for _, line in pair)),
        len(lines),
    )
    candidates = []
    for place, (_, line) in enumerate(lines[:PREAMBLE]):
        fields = split(line.lstrip("#"), separator)
        # A line of settings may name the time once for each channel.
        known = len({field.lower() for field in fields if is_known(field)})
        is_comment = line.startswith("#")
        # Settings before the header may hold several lines of numbers.
        if place > first and (known < 2 or any(candidate[1] > 1 for candidate in candidates)):
            continue
        if known or (place < first and len(fields) > 1 and not is_comment and not values_in(line, separator)):
            candidates.append(((known > 0) + (known > 0 and not is_comment), known, place))
    return max(candidates)[2] if candidates else None


def parse(text: str, path: str | Path, is_known: Callable[[str], bool], units: Iterable[str], example: str) -> Table:
    """The table in a text; TableError says why there is none.

    is_known : whether a column with this name is one that is looked for
    units : that the line below the header may state
    example : a header, for messages
    """
    import numpy as np
    import pandas as pd

    text = text.replace("\u2212", "-")  # the minus of typesetters
    content = [(number, line.strip(" \r")) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    content = [(number, line) for number, line in content if not EXCEL_LINE.fullmatch(line)]
    while content and not content[-1][1].strip(',;\t" '):  # empty rows of a spreadsheet
        content.pop()
    if all(line.startswith("#") for _, line in content):
        raise TableError([f"{path}:1: is empty; the first line names the columns, such as {example}"])
    try:
        written = [line for _, line in content if not line.startswith("#")]
        separator = separator_of(written)
        if len(written) > 1 and not any(values_in(line, separator) for line in written):
            remedy = "separate columns by commas, semicolons, tabs or spaces, and write -1.5 or 2e-3 for a number"
            raise TableError([f"{path}: has no line with two numbers; {remedy}"])
        place = find_header(content, separator, is_known)
        if place is None:
            header, line = next((number, line) for number, line in content if not line.startswith("#"))
            names = [str(number) for number in range(1, len(split(line, separator)) + 1)]
            if not any(map(is_known, names)):
                remedy = f"a line above the values, separated like them, must name the columns, such as {example}"
                raise TableError([f"{path}:{header}: begins without names; {remedy}"])
            place = -1
            units_of = [""] * len(names)
        else:
            header, line = content[place]
            line = line.lstrip("# ")
            # Where spaces separate columns, a unit behind one belongs to the name before it.
            line = re.sub(r"(?<=\w) +(?=[(\[])", "", line) if separator == " " else line
            named = [name_and_unit(field, units) for field in split(line, separator)]
            names, units_of = map(list, zip(*named, strict=True))
        beside = [content[near] for near in (place - 1, place + 1) if 0 <= near < len(content)] if place >= 0 else []
        stating = []
        for numbered in beside:
            stated = split(numbered[1].lstrip("# "), separator)
            if len(stated) > 1 and is_unit_line(stated, units):
                stating.append(numbered)
                padded = [*stated, *[""] * len(names)]
                units_of = [UNIT.sub(r"\1", field) or unit for field, unit in zip(padded, units_of, strict=False)]
        following = [numbered for numbered in content[place + 1 :] if numbered not in stating]
        rows = [(number, line) for number, line in following if not line.lstrip('"').startswith("#")]
        widths = np.array([widths_of(line, separator) for _, line in rows], dtype=np.int64)
    except csv.Error as error:
        raise TableError([f"{path}: is not CSV ({error}); export the table as CSV"]) from error
    while names and not names[-1]:  # a separator at the end of the line
        names, units_of = names[:-1], units_of[:-1]
    lines = np.array([number for number, _ in rows], dtype=np.int64)
    faults = []
    # Where most lines end before the last names, such as `Comment`, these columns are empty.
    usual = min(int(np.median(widths)), len(names)) if rows else 0
    shortest = len(names) if any(map(is_known, names[usual:])) else usual
    for row in np.flatnonzero((widths != len(names)) & (widths != shortest)):
        ends_empty = widths[row] > len(names) and not any(split(rows[row][1], separator)[len(names) :])
        if not ends_empty and len(faults) < MOST_FAULTS:
            remedy = "leave no field out, and separate columns by semicolons if numbers have commas"
            if row == len(rows) - 1 and widths[row] < len(names):
                remedy = f"{DELETE}, the last one, which may be incomplete"
            values = f"{widths[row]} value{'s' if widths[row] != 1 else ''}"
            faults.append(f"{path}:{lines[row]}: has {values} for {len(names)} columns; {remedy}")
    if faults:
        raise TableError(faults)
    columns = range(widths.max(initial=len(names)))
    fields = pd.DataFrame(columns=columns, dtype=str)
    if rows:
        options = {"header": None, "names": columns, "dtype": str, "keep_default_na": False, "index_col": False}
        options |= {"sep": r"\s+" if separator == " " else separator, "skipinitialspace": True}
        try:
            fields = pd.read_csv(io.StringIO("\n".join(line for _, line in rows)), **options)
            reason = "a quote is not closed"
        except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
            reason = str(error)
        if len(fields) != len(rows):
            raise TableError([f"{path}:{lines[-1]}: is not CSV ({reason}); export the table as CSV"])
    fields = fields[range(len(names))].fillna("").apply(lambda column: column.str.strip())
    try:
        signs = number_signs([fields[column] for column in fields], separator)
    except ValueError as error:
        number = str(error)
        readings = f"{number.replace(',', '')} or {number.replace(',', '.')}"
        remedy = "write decimal points, and no sign between thousands"
        raise TableError([f"{path}: has the number {number}, which may be {readings}; {remedy}"]) from error
    return Table(str(path), header, names, units_of, lines, fields, signs)


def widths_of(line: str, separator: str) -> int:
    """The number of fields of a line."""
    if '"' in line or separator == " ":
        return len(split(line, separator))
    return line.count(separator) + 1


def is_grouped_by_points(texts: Any) -> bool:
    """Whether the numbers of a column are whole, with points between thousands, and some have less than a thousand."""
    is_short = texts.str.fullmatch(r"[-+]?\d{1,3}")
    return bool(is_short.any() and (is_short | texts.str.fullmatch(r"[-+]?[1-9]\d{0,2}(\.\d{3})+")).all())


def number_signs(fields: Sequence[Any], separator: str) -> tuple[str, str]:
    """The decimal sign and the sign between thousands (may be empty) in columns of texts.

    A comma alone is decimal, unless a number has two of them, or each stands before three digits while other numbers
    have a point. Points beside decimal commas are between thousands if each stands before three digits in a column that
    has shorter numbers without any. If else some numbers have commas and more have points, commas are mistakes.

    Raises
    ------
    ValueError
        a number that may have a decimal comma or thousands: each comma stands before three digits, and other numbers
        are short and have none. In a file with semicolons such a comma is decimal, unless its column has short numbers
    """
    if not any(texts.str.contains(r",|\..*\.").any() for texts in fields):
        return ".", ""  # as in most files, without a closer look at each number
    fields = [texts[texts.str.fullmatch(NUMBER.pattern)] for texts in fields]
    commas = [texts[texts.str.contains(",", regex=False)] for texts in fields]
    points = sum(int(texts.str.contains(".", regex=False).sum()) for texts in fields)
    if not any(map(len, commas)):
        twice = any(texts.str.contains(r"\..*\.").any() for texts in fields)
        return (",", ".") if twice else (".", "")
    for texts in commas:
        if (both := texts[texts.str.contains(".", regex=False)]).size:
            is_point_last = both.str.rfind(".") > both.str.rfind(",")
            return (".", ",") if is_point_last.all() else (",", ".")
    if any(texts.str.contains(r",.*,").any() for texts in commas):
        return ".", ","
    grouped = all(texts.str.fullmatch(r"[-+]?[1-9]\d{0,2},\d{3}").all() for texts in commas)
    if grouped and points:
        return ".", ","
    if grouped:
        shorts = [texts.str.fullmatch(r"[-+]?\d{1,3}").sum() for texts in fields]
        mixed = [(len(texts), short) for texts, short in zip(commas, shorts, strict=True) if len(texts) and short]
        # Of many decimals without a fixed number of digits, some would have fewer than three.
        if mixed and max(mixed)[0] >= SURELY_THOUSANDS:
            return ".", ","
        if mixed or (any(shorts) and separator != ";"):
            raise ValueError(next(texts.iloc[0] for texts in commas if len(texts)))
    with_points = [texts for texts in fields if texts.str.contains(".", regex=False).any()]
    if with_points and all(map(is_grouped_by_points, with_points)):
        return ",", "."
    return (".", "") if points > sum(map(len, commas)) else (",", "")


def to_numbers(texts: Any, signs: tuple[str, str]) -> Any:
    """The numbers in a column of texts, with the signs of `number_signs`; NaN for other texts."""
    import pandas as pd

    decimal, thousands = signs
    if texts.str.contains("[\u00a0\u202f']").any():
        texts = texts.str.replace(r"(?<=\d)[\u00a0\u202f'](?=\d{3})", "", regex=True)
    if thousands:
        escaped = re.escape(thousands)
        is_grouped = texts.str.fullmatch(rf"[-+]?\d{{1,3}}({escaped}\d{{3}})*([^{escaped}\d].*)?|[^{escaped}]*")
        texts = texts.where(is_grouped, "").str.replace(thousands, "", regex=False)
    if decimal == ",":
        # A point beside decimal commas is no number.
        texts = texts.where(~texts.str.contains(".", regex=False), "").str.replace(",", ".", regex=False)
    texts = texts.where(~texts.str.contains("_", regex=False), "")
    return pd.to_numeric(texts, errors="coerce").to_numpy()


def clock_seconds(texts: Any) -> Any:
    """Times (s) from the first one on, of clock times, also past midnight or, without hours, past the hour; NaN for
    other texts.

    The date matters only where it changes: that is a day later, so a date of any form will do.
    """
    import numpy as np
    import pandas as pd

    parts = texts.str.extract(f"^{CLOCK.pattern}$", flags=CLOCK.flags)
    hours = pd.to_numeric(parts.hours)
    is_afternoon = parts.half.str.upper() == "PM"
    hours = hours.where(parts.half.isna(), hours % 12 + 12 * is_afternoon)
    seconds = pd.to_numeric(parts.seconds.str.replace("[,:]", ".", regex=True))
    offset = parts.offset.str.replace(":", "").str.ljust(5, "0").fillna("+0000")
    ahead = HOUR * pd.to_numeric(offset.str[:3]) + 60.0 * pd.to_numeric(offset.str[0] + offset.str[3:])
    clock = HOUR * hours.fillna(0.0) + 60.0 * pd.to_numeric(parts.minutes) + seconds
    # A clock may change its offset from UTC, as where daylight saving begins.
    time = (clock - (ahead - ahead.iloc[0])).to_numpy(dtype=np.float64)
    turn = HOUR if hours.isna().all() else DAY
    is_next = np.diff(time, prepend=time[:1]) < -0.5 * turn
    if parts.date.notna().all():
        is_next = (parts.date != parts.date.shift(fill_value=parts.date.iloc[0])).to_numpy()
    return time - time[0] + turn * np.cumsum(is_next)


def number_fault(name: str, text: str, remedy: str) -> str:
    """Why a text is not a measured number, with the remedy."""
    shown = f"{name} = {text[:40]!r}"
    if not text:
        return f"has no {name}; fill it in, or {remedy}"
    if text.lstrip("+-").lower() in ("nan", "inf", "infinity") or re.fullmatch(r"[-+]?[\d.]+[eE]\+?\d+", text):
        return f"{shown} is not a measured number; {remedy}"
    if re.fullmatch(r"[-+]?\d*,\d+", text):
        return f"{shown} has a decimal comma, other numbers have points; write {text.replace(',', '.')}"
    return f"{shown} is text; write a number without the unit"
