"""Types of config values: numbers with unit and range, intervals, axes, mappings."""

from functools import partial
from typing import Annotated, Any, Literal, Union

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, WrapValidator
from typing_extensions import TypedDict

from scripts.conveyor.parameters import DESCRIPTIONS, PARAMETERS, RANGES, TENSION_MODES, UNITS

LONGEST_NAME = 64  # characters: names become file names
LONGEST_LIST = 10_000  # values; a longer axis is written as {start, stop, num}
MOST_POINTS = 1_000_000  # of one axis
NAME = rf"[A-Za-z][A-Za-z0-9_-]{{0,{LONGEST_NAME - 1}}}"


def number(description: str, unit: str = "", **bounds: float) -> Any:
    """A finite number with a unit and the bounds ge, gt, le, lt."""
    extra = {"unit": unit} if unit else None
    return Annotated[float, Field(description=description, allow_inf_nan=False, json_schema_extra=extra, **bounds)]


def as_integer(value: Any) -> Any:
    """A whole number in any spelling (5.0e+4) as an integer."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def whole(description: str, least: int, most: int, unit: str = "") -> Any:
    extra = {"unit": unit} if unit else None
    return Annotated[
        int,
        Field(ge=least, le=most),
        BeforeValidator(as_integer),
        Field(description=description, json_schema_extra=extra),
    ]


def as_written(value: Any, validate) -> Any:
    """Check a number and keep it as an integer or a float, as the config file has it."""
    validate(value)
    return value


def text(description: str, pattern: str, expected: str) -> Any:
    extra = {"patternErrorMessage": expected}
    return Annotated[str, Field(description=description, pattern=f"^{pattern}$", json_schema_extra=extra)]


def line(description: str) -> Any:
    return text(description, r"[^\x00-\x1f]+", "text on one line; put it in quotes")


def word(description: str, *words: str) -> Any:
    return Annotated[Literal[words], Field(description=description)]


def mapping(description: str, keys: dict[str, Any], total: bool = True) -> Any:
    """A mapping with these keys; `total` says whether all of them are required."""
    return Annotated[TypedDict(description, keys, total=total), Field(description=description)]


def named(description: str, item: Any, **bounds: int) -> Any:
    """A mapping from names that the user chooses."""
    return Annotated[dict[Name, item], Field(description=description, **bounds)]


Name = text(
    "name",
    NAME,
    f"a name of letters, digits, - and _ that begins with a letter, of at most {LONGEST_NAME} characters",
)
Reference = text("table of the config, as SECTION/NAME", rf"[a-z_]+/{NAME}", "SECTION/NAME, as in sweeps/amplitudes")


def check_distinct(values: list) -> list:
    seen = set()
    for value in values:
        if value in seen:
            raise ValueError(f"has {value!r} twice; give each value once")
        seen.add(value)
    return values


def check_ascending(values: list) -> list:
    if sorted(set(values)) != values:
        raise ValueError("is not ascending; sort the values and give each value once")
    return values


def check_interval(values: list, point: bool) -> list:
    low, high = values
    if low is high is None:
        raise ValueError("has no bound; give at least one")
    if low is not None and high is not None and (low > high or (low == high and not point)):
        raise ValueError(f"is {'reversed' if low > high else 'empty'}; give [least, largest]")
    return values


def check_span(values: dict) -> dict:
    start, stop, num = values["start"], values["stop"], values["num"]
    if start > stop:
        raise ValueError("is reversed: start is above stop; exchange start and stop")
    if start == stop and num > 1:
        raise ValueError(f"has start = stop for {num} equal values; give num: 1, or another stop")
    return values


def interval(item: Any, description: str, point: bool = False) -> Any:
    """[least, largest], or null for no bound; `point` says whether both may be equal."""
    check = AfterValidator(partial(check_interval, point=point))
    return Annotated[list[item], Field(min_length=2, max_length=2), check, Field(description=description)]


def many(item: Any, description: str, least: int = 1, check=check_distinct) -> Any:
    """A list of distinct values."""
    return Annotated[
        list[item],
        Field(min_length=least, max_length=LONGEST_LIST, fail_fast=True),
        AfterValidator(check),
        Field(description=description),
    ]


def span(item: Any, description: str, least: int = 2) -> Any:
    """{start, stop, num}: num evenly spaced values from start to stop, both included."""
    keys = {"start": item, "stop": item, "num": whole("number of values", least, MOST_POINTS)}
    return Annotated[mapping(description, keys), AfterValidator(check_span), Field(description=description)]


def axis_form(value: Any) -> str | None:
    return "(span)" if isinstance(value, dict) else "(list)" if isinstance(value, list) else None


AXIS_FORM = Discriminator(
    axis_form,
    custom_error_type="axis",
    custom_error_message="Input should be a list of values, or {start: …, stop: …, num: …}",
)


def axis(item: Any, description: str, end: Any = None, least: int = 1, check=check_distinct) -> Any:
    """A list of values or a span; `end` is the type of start and stop where a value may also be a word."""
    values = Annotated[many(item, description, least, check), Tag("(list)")]
    evenly_spaced = Annotated[span(end or item, description, least), Tag("(span)")]
    return Annotated[Union[values, evenly_spaced], AXIS_FORM, Field(description=description)]  # noqa: UP007


def keep_order(values: Any, validate) -> dict:
    """Keep the order of the axes, because the first one varies slowest."""
    checked = validate(values)
    if not checked:
        raise ValueError(f"is empty; give at least one axis: {', '.join(PARAMETERS)}")
    return {name: checked[name] for name in values}


def height_form(value: Any) -> str | None:
    return "(word)" if value == "conveyor" else None if isinstance(value, str) else "(number)"


def parameter(name: str, description: str = "", unit: str = "") -> Any:
    """A number with the range of a parameter of the library."""
    low, high = RANGES[name]
    return number(description or DESCRIPTIONS[name], unit or UNITS[name], ge=low, le=high)


HEIGHT_FORM = Discriminator(
    height_form,
    custom_error_type="height",
    custom_error_message="Input should be a number, or the word conveyor",
)
HEIGHTS = Union[Annotated[parameter("z0"), Tag("(number)")], Annotated[Literal["conveyor"], Tag("(word)")]]  # noqa: UP007
MODEL_TYPES = {name: parameter(name) for name in RANGES} | {
    "tension": word(DESCRIPTIONS["tension"], *TENSION_MODES),
    "z0": Annotated[HEIGHTS, HEIGHT_FORM, Field(description=DESCRIPTIONS["z0"])],
}
MODEL_TYPES = {name: MODEL_TYPES[name] for name in PARAMETERS}
AXIS_TYPES = {name: axis(item, DESCRIPTIONS[name]) for name, item in MODEL_TYPES.items()}
AXIS_TYPES["z0"] = axis(MODEL_TYPES["z0"], DESCRIPTIONS["z0"], parameter("z0"))
AXIS_TYPES["tension"] = many(MODEL_TYPES["tension"], DESCRIPTIONS["tension"])
Model = mapping("parameters that differ from those of `model`", MODEL_TYPES, total=False)
Axes = Annotated[
    mapping("one table row per combination; the first axis varies slowest", AXIS_TYPES, total=False),
    WrapValidator(keep_order),
    Field(description="axes of the table: lists of values or {start, stop, num}; the first one varies slowest"),
]
