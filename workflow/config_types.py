"""What values of the config may be: numbers with their ranges and units, words, intervals, axes.

Every type converts what it accepts to one form, so that 20, 20.0 and 2.0e+1 are the same float, and says in words what
it does not accept: the text goes behind the key, "model.mass = -0.1 is outside …". Under a context, functions by units,
numbers of these units are changed by them (see own_machine).
"""

import ast
import difflib
import math
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from reprlib import Repr
from textwrap import shorten
from typing import Annotated, Any, Literal, NamedTuple, Union

from pydantic import AfterValidator, Discriminator, Field, PlainValidator, Tag, ValidationInfo, WrapValidator
from pydantic_core import PydanticCustomError
from typing_extensions import TypedDict

ROOT = Path(__file__).resolve().parent.parent
LONGEST_NAME = 64  # characters: names become names of files
LARGEST_AXIS = 1_000_000  # points
# Values in messages are cut, and brought to one line.
SHORT = Repr()
SHORT.maxstring = SHORT.maxother = 60
shown = SHORT.repr


def wrong(text: str) -> PydanticCustomError:
    """An error whose text goes behind the key."""
    return PydanticCustomError("config", "{text}", {"text": text})


def did_you_mean(name, known: Iterable[str]) -> str:
    """The remedy for a name that is not known."""
    close = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {close[0]}?" if close else f"there are {shorten(', '.join(known) or 'none', 300)}"


def constants(file: str, *names: str) -> dict[str, Any]:
    """Constants of a module of scripts/, by their names, without the slow imports of NumPy and Numba."""
    body = [
        node
        for node in ast.parse((ROOT / "scripts" / file).read_bytes()).body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id in names
    ]
    namespace = {"math": math}
    exec(compile(ast.Module(body, []), file, "exec"), namespace)
    return {name: namespace[name] for name in names}


LIBRARY = constants("conveyor/solver/model.py", "PARAMETERS", "TENSION_MODES", "UNITS", "RANGES") | constants(
    "conveyor/methods/fixed_step.py", "METHODS", "EVALUATIONS", "GROWTH"
)


class Allowed(NamedTuple):
    """What a type allows, in words, for the page of all keys."""

    values: str
    unit: str = ""


def reads_as_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def checked(value, kind: str, unit: str) -> int | float:
    """A finite number, or an error that says what is no number (of this kind and unit)."""
    if isinstance(value, str) and reads_as_number(value):
        raise wrong(f"= {value!r} is text to YAML; write it with a decimal point and a signed exponent (1.0e-4)")
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise wrong(f"= {shown(value)} is not {kind}{f' ({unit})' if unit else ''}")
    if isinstance(value, float) and not math.isfinite(value):
        raise wrong(f"= {value!r} is not a finite number")
    return value


def outside(value: float, low: float, high: float, unit: str, ends: str) -> str:
    """How a number misses its range, with the usual mix-up of units."""
    text = f"= {shown(value)} is outside {ends[0]}{low:g}, {high:g}{ends[1]} {unit}".rstrip()
    if unit == "rad" and high < abs(value) <= 360:
        text += f"; angles are in radians, {value:g}° are {math.radians(value):.4f} rad"
    return text


def brought(value: float, unit: str, info: ValidationInfo) -> float:
    """A number of a unit, changed as the context of the validation says."""
    change = (info.context or {}).get(unit)
    return change(value) if change else value


def number(low: float, high: float, unit: str = "", ends: str = "[]", form: Callable[[Any], float] = float):
    """A finite number between `low` and `high`; `ends` are those of the interval, "(]" leaves the lower one out."""

    def check(value, info: ValidationInfo):
        value = checked(value, "a number", unit)
        above = low < value if ends[0] == "(" else low <= value
        below = value < high if ends[1] == ")" else value <= high
        if not (above and below):
            raise wrong(outside(value, low, high, unit, ends))
        return form(brought(value, unit, info))

    return Annotated[float, PlainValidator(check), Allowed(f"number in {ends[0]}{low:g}, {high:g}{ends[1]}", unit)]


def positive(high: float, unit: str = ""):
    return number(0, high, unit, "(]")


def whole(low: int, high: int, unit: str = "", few: str = "", many: str = ""):
    """A whole number between `low` and `high`, in any spelling (5.0e+4); `few` and `many` are said of one outside."""

    def check(value):
        value = checked(value, "a whole number", unit)
        if value != int(value):
            raise wrong(f"= {value!r} is not a whole number")
        if not low <= value <= high:
            reason = few if value < low else many
            raise wrong(f"= {shown(int(value))} {reason}" if reason else outside(value, low, high, unit, "[]"))
        return int(value)

    return Annotated[int, PlainValidator(check), Allowed(f"whole number in [{low:g}, {high:g}]", unit)]


def word(*words: str):
    def check(value):
        if value not in words:
            raise wrong(f"= {shown(value)} is not one of {', '.join(words)}")
        return value

    return Annotated[Literal[words], PlainValidator(check), Allowed(", ".join(words))]


def text(pattern: str, expected: str):
    """Text that the pattern matches from end to end."""

    def check(value):
        if not isinstance(value, str) or not re.fullmatch(pattern, value):
            raise wrong(f"= {shown(value)} is not {expected}")
        return value

    return Annotated[str, PlainValidator(check), Allowed(expected)]


Line = text(r"[^\x00-\x1f]+", "text on one line; put it in quotes")
NAME = rf"[A-Za-z][A-Za-z0-9_-]{{0,{LONGEST_NAME - 1}}}"
Name = text(NAME, f"a name of letters, digits, - and _ that begins with a letter, of at most {LONGEST_NAME} characters")
Reference = text(rf"[a-z_]+/{NAME}", "SECTION/NAME, as in sweeps/amplitudes")


def distinct(values: list) -> list:
    if len(set(values)) < len(values):
        repeated = next(value for value in values if values.count(value) > 1)
        raise wrong(f"= {shown(values)} has {repeated!r} twice; give each value once")
    return values


def ascending(values: list) -> list:
    if sorted(set(values)) != values:
        raise wrong(f"= {shown(values)} is not ascending; write {shown(sorted(set(values)))}")
    return values


def interval(end, point: bool = False):
    """[least, largest] of numbers, or of numbers and null; `point` tells whether both may be equal."""

    def check(values):
        low, high = values
        if low is high is None:
            raise wrong("= [null, null] has no bound; give at least one")
        if low is not None and high is not None and (low > high or (low == high and not point)):
            raise wrong(f"= {shown(values)} is {'reversed' if low > high else 'empty'}; give [least, largest]")
        return values

    return Annotated[
        list[end], Field(min_length=2, max_length=2), AfterValidator(check), Allowed("[least, largest], each")
    ]


def many(item):
    """A list of at least one value, none of them twice."""
    return Annotated[list[item], Field(min_length=1), AfterValidator(distinct)]


def forwards(values: dict) -> dict:
    """{start, stop, num} whose start is the smaller one."""
    start, stop, num = values["start"], values["stop"], values["num"]
    if start > stop:
        raise wrong(f"is reversed: start = {start!r} is above stop = {stop!r}; exchange them")
    if start == stop and num > 1:
        raise wrong(f"has start = stop = {start!r} for {num} equal values; give one, or another stop")
    return values


def span(end, points):
    """{start, stop, num}: num values from start to stop, both included."""
    return Annotated[TypedDict("Span", {"start": end, "stop": end, "num": points}), AfterValidator(forwards)]


TOO_MANY = f"makes too many points; give at most {LARGEST_AXIS}"
Points = whole(1, LARGEST_AXIS, few="makes an empty axis; give at least 1", many=TOO_MANY)
AtLeastTwo = whole(2, LARGEST_AXIS, few="makes no two points; give at least 2", many=TOO_MANY)


def axis(item, end=None, values=many, points=Points):
    """A list of values, or {start, stop, num}; `end` is the type of start and stop if it is not that of a value."""

    def kind(value) -> str | None:
        return "‹list›" if isinstance(value, list) else "‹span›" if isinstance(value, dict) else None

    return Annotated[
        Union[Annotated[values(item), Tag("‹list›")], Annotated[span(end or item, points), Tag("‹span›")]],  # noqa: UP007
        Discriminator(
            kind,
            custom_error_type="axis",
            custom_error_message="is no axis; give a list of values, or {start: …, stop: …, num: …}",
        ),
    ]


def in_given_order(values, handler):
    """The order of axes means something: the first one varies slowest."""
    found = handler(values)
    if not found:
        raise wrong(f"is empty; give at least one axis: {', '.join(LIBRARY['PARAMETERS'])}")
    return {name: found[name] for name in values}


# Parameters of the model, with the ranges and units of the library.
NUMBERS = {name: number(low, high, LIBRARY["UNITS"][name]) for name, (low, high) in LIBRARY["RANGES"].items()}


def height(value, info: ValidationInfo):
    """An initial height."""
    if isinstance(value, str) and not reads_as_number(value):
        if value != "conveyor":
            raise wrong(f"= {shown(value)} is not a number in m, or the word conveyor (start on the conveyor)")
        return value
    low, high = LIBRARY["RANGES"]["z0"]
    value = checked(value, "a number", "m, or the word conveyor")
    if not low <= value <= high:
        raise wrong(outside(value, low, high, "m", "[]"))
    return float(brought(value, "m", info))


Height = Annotated[
    float | str,
    PlainValidator(height),
    Allowed("number in [{:g}, {:g}], or conveyor".format(*LIBRARY["RANGES"]["z0"]), "m"),
]
PARAMETERS = {
    name: {"z0": Height, "tension": word(*LIBRARY["TENSION_MODES"])}.get(name) or NUMBERS[name]
    for name in LIBRARY["PARAMETERS"]
}
Scan = axis(
    NUMBERS["z0"],
    values=lambda item: Annotated[list[item], Field(min_length=2), AfterValidator(ascending)],
    points=AtLeastTwo,
)
AXES = {name: axis(parameter, NUMBERS.get(name)) for name, parameter in PARAMETERS.items() if name != "tension"}
Axes = Annotated[
    TypedDict(
        "Axes", {name: AXES[name] if name in AXES else many(PARAMETERS[name]) for name in PARAMETERS}, total=False
    ),
    WrapValidator(in_given_order),
]
Model = TypedDict("Model", PARAMETERS, total=False)
WholeModel = TypedDict("WholeModel", PARAMETERS)
