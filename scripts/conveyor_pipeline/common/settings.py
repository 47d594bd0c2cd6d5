"""Types of config values: numbers with unit and range, lists, intervals, axes."""

from functools import partial
from typing import Annotated, Any, Literal, NotRequired

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, WrapValidator
from pydantic_core import PydanticCustomError
from typing_extensions import TypedDict

from conveyor import PARAMETERS, RANGES, UNITS
from conveyor.parameters import DESCRIPTIONS, FIXED_STEP_METHODS, HARMONIC, HARMONICS, MOST_HARMONICS, TENSION_MODES
from conveyor_pipeline.common.quantities import QuantityError, in_unit, is_quantity

LONGEST_NAME = 64  # characters: names become file names
LONGEST_LIST = 10_000  # values; a longer axis is written as {start, stop, num}
MOST_POINTS = 1_000_000  # of one axis
NAME = rf"[A-Za-z][A-Za-z0-9_-]{{0,{LONGEST_NAME - 1}}}"


def number(description: str, unit: str = "", **bounds: float) -> Any:
    """A number with a unit and the bounds ge, gt, le, lt; a text may have another unit, such as 20 deg for rad."""
    field = Field(description=description, json_schema_extra={"unit": unit} if unit else None, **bounds)
    return Annotated[float, field, BeforeValidator(partial(as_number, unit))]


def whole(description: str, minimum: int, maximum: int, unit: str = "") -> Any:
    """A whole number in any spelling: 50000 or 5.0e+4."""
    extra = {"unit": unit} if unit else None
    field = Field(ge=minimum, le=maximum, description=description, json_schema_extra=extra)
    return Annotated[int, field, BeforeValidator(as_integer)]


def as_integer(value: Any) -> Any:
    if isinstance(value, str) and is_number(value):
        value = float(value)
    return int(value) if isinstance(value, float) and value.is_integer() else refuse_truth(value)


def as_number(unit: str, value: Any) -> Any:
    """The number of a text with a unit, in the unit of its key."""
    if isinstance(value, str) and not is_number(value):
        try:
            return in_unit(value, unit)
        except QuantityError as error:
            raise PydanticCustomError("quantity", f"Input {error}") from error
    return refuse_truth(value)


def refuse_truth(value: Any) -> Any:
    """A value that is neither true nor false, which are the numbers 1 and 0 to Python."""
    if isinstance(value, bool):
        raise PydanticCustomError("number", "Input should be a number")
    return value


def is_number(text: str) -> bool:
    """Whether a text is a number: to YAML 1.1, with which other workflows read their config, 1e-8 is a text."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def text(description: str, pattern: str, expected: str) -> Any:
    """A text that matches a pattern; error messages state what is `expected` instead."""
    extra = {"patternErrorMessage": expected}
    return Annotated[str, Field(description=description, pattern=f"^{pattern}$", json_schema_extra=extra)]


def described(item: Any, description: str, **bounds: int) -> Any:
    """A type with its own description, and for a mapping or a list the bounds min_length and max_length."""
    return Annotated[item, Field(description=description, **bounds)]


def word(description: str, *words: str) -> Any:
    """One of several words."""
    return described(Literal[words], description)


def mapping(description: str, keys: dict[str, Any], total: bool = True) -> Any:
    """A small mapping without its own class; `total` says whether all of its keys are required."""
    return described(TypedDict("_".join(keys), keys, total=total), description)


Line = text("text", r"[^\x00-\x1f]+", "text on one line; put it in quotes")
Name = text(
    "name",
    NAME,
    f"a name of letters, digits, - and _ that begins with a letter, of at most {LONGEST_NAME} characters",
)
Reference = text("table of the config, as SECTION/NAME", rf"[a-z_]+/{NAME}", "SECTION/NAME, as in sweeps/amplitudes")


def entries(item: Any, description: str, **bounds: int) -> Any:
    """A mapping whose keys are names of the user's choice."""
    return described(dict[Name, item], description, **bounds)


def check_distinct(values: list) -> list:
    seen = set()
    for value in values:
        if value in seen:
            raise ValueError(f"has {value!r} twice; give each value once")
        seen.add(value)
    return values


def check_orders(harmonics: list) -> list:
    orders = [harmonic["order"] for harmonic in harmonics]
    if len(set(orders)) < len(orders):
        raise ValueError(f"has the orders {orders}; give each order once")
    return harmonics


def check_ascending(values: list) -> list:
    if sorted(set(values)) != values:
        raise ValueError("is not ascending; sort the values and give each value once")
    return values


def check_interval(values: list, point: bool) -> list:
    low, high = values
    if low > high or (low == high and not point):
        raise ValueError(f"is {'reversed' if low > high else 'empty'}; give [least, largest]")
    return values


def check_span(values: dict) -> dict:
    if len(values) < 3:  # the default has the other keys
        return values
    start, stop, num = values["start"], values["stop"], values["num"]
    if start > stop:
        raise ValueError("is reversed: start is above stop; give both, the smaller one as start")
    if num == 1 and start != stop:
        raise ValueError(f"has num: 1 for two ends; give more values, or a list such as [{start!r}]")
    if start == stop and num > 1:
        raise ValueError(f"has start = stop for {num} equal values; give num: 1, or another stop")
    return values


def list_of(item: Any, description: str, min_length: int = 1, check=check_distinct) -> Any:
    """A list of distinct values."""
    field = Field(min_length=min_length, max_length=LONGEST_LIST, fail_fast=True, description=description)
    return Annotated[list[item], field, AfterValidator(check)]


def interval(item: Any, description: str, point: bool = False) -> Any:
    """[least, largest]; `point` says whether both may be equal."""
    field = Field(min_length=2, max_length=2, description=description)
    return Annotated[list[item], field, AfterValidator(partial(check_interval, point=point))]


def span(item: Any, description: str, min_length: int = 2, partial: bool = False) -> Any:
    """{start, stop, num}: num evenly spaced values from start to stop, both included; some of them, if `partial`."""
    keys = {"start": item, "stop": item, "num": whole("number of values", min_length, MOST_POINTS)}
    return Annotated[mapping(description, keys, total=not partial), AfterValidator(check_span)]


def union(description: str, expected: str, choose, **forms: Any) -> Any:
    """One of several forms; `choose` returns the name of the form that a value has, or None.

    The location of an error contains this name in brackets.
    """
    first, second = (Annotated[form, Tag(f"({name})")] for name, form in forms.items())
    form = Discriminator(
        lambda value: f"({choose(value)})" if choose(value) else None,
        custom_error_type="form",
        custom_error_message=f"Input should be {expected}",
    )
    return Annotated[first | second, form, Field(description=description)]


def axis_form(value: Any) -> str | None:
    return "span" if isinstance(value, dict) else "list" if isinstance(value, list) else None


def height_form(value: Any) -> str | None:
    is_other_text = isinstance(value, str) and not (is_number(value) or is_quantity(value))
    return "word" if value == "conveyor" else None if is_other_text else "number"


def axis(
    item: Any, description: str, end: Any = None, min_length: int = 1, check=check_distinct, partial: bool = False
) -> Any:
    """A list of values or a span; `end` is the type of start and stop where a value may also be a word."""
    forms = {
        "list": list_of(item, description, min_length, check),
        "span": span(end or item, description, min_length, partial),
    }
    return union(description, "a list of values, or {start: …, stop: …, num: …}", axis_form, **forms)


def parameter(name: str, description: str = "") -> Any:
    """A number with the unit and the range of a parameter of the library."""
    low, high = RANGES[name]
    return number(description or DESCRIPTIONS[name], UNITS[name], ge=low, le=high)


def dimensionless(**keys: Any) -> Any:
    """Values in the scales of the conveyor, which scripts/conveyor_pipeline/config/scales.py converts to SI units."""
    about = (
        "throw numbers, heights in g cos α/ω², velocities in g cos α/ω, times in cycles, frequencies over the model's"
    )
    return NotRequired[mapping(f"{about}; values in SI units beside this key replace them", keys)]


THROW = number("throw number a_z/(g cos α)", ge=0, le=1e6)


def keep_order(values: Any, validate) -> dict:
    """Keep the order of the axes, because the first one varies slowest."""
    checked = validate(values)
    if not checked:
        raise ValueError(f"is empty; give at least one axis: {', '.join(PARAMETERS)}")
    return {name: checked[name] for name in values}


MODEL_TYPES = {name: parameter(name) for name in RANGES} | {
    "tension": word(DESCRIPTIONS["tension"], *TENSION_MODES),
    "z0": union(
        DESCRIPTIONS["z0"],
        "a number, or the word conveyor",
        height_form,
        number=parameter("z0"),
        word=Literal["conveyor"],
    ),
}
MODEL_TYPES = {name: MODEL_TYPES[name] for name in PARAMETERS}
HARMONIC_TYPES = {
    name: number(description, unit, ge=low, le=high) for name, (description, unit, (low, high)) in HARMONIC.items()
}
HARMONIC_TYPES |= {"order": whole(HARMONIC["order"][0], *HARMONIC["order"][2])}
OPTIONAL = {
    "static_friction": NotRequired[MODEL_TYPES["static_friction"]],
    "harmonics": NotRequired[
        Annotated[
            list[mapping("a harmonic of the plate's acceleration, with the phase θ of the excitation", HARMONIC_TYPES)],
            Field(max_length=MOST_HARMONICS, description=HARMONICS),
            AfterValidator(check_orders),
        ]
    ],
}
# Keys of the section `model`; without its own value static_friction is equal to friction.
MODEL_KEYS = MODEL_TYPES | OPTIONAL
AXIS_TYPES = {name: axis(item, DESCRIPTIONS[name]) for name, item in MODEL_TYPES.items()} | {
    "tension": list_of(MODEL_TYPES["tension"], DESCRIPTIONS["tension"]),
    "z0": axis(MODEL_TYPES["z0"], DESCRIPTIONS["z0"], end=parameter("z0")),
}
Axes = Annotated[
    TypedDict("Axes", AXIS_TYPES, total=False),
    WrapValidator(keep_order),
    Field(description="axes of the table: lists of values or {start, stop, num}; the first one varies slowest"),
]
Model = described(TypedDict("Model", MODEL_KEYS, total=False), "parameters that differ from the section `model`")

# Types of several keys.
Acceleration, Accelerations = MODEL_TYPES["acceleration"], AXIS_TYPES["acceleration"]
Height, HeightNumber = MODEL_TYPES["z0"], parameter("z0", "height above the mean position of the plate")
Velocity = parameter("vz0")
Duration = number("simulated time of a run", "s", gt=0, le=1e6)
Method = word("event, or a method with a fixed step", "event", *FIXED_STEP_METHODS)
Tolerance = number("relative error per step of the method event", ge=1e-14, le=1e-2)
Step = number("time step of the fixed-step methods", "s", ge=1e-12, le=1e-1)
Seed = whole("seed of the random numbers", 0, 2**32 - 1)
Effort = number("factor of the numbers of points and runs; below 1, tables are coarse", ge=0.01, le=100)
Period = whole("longest period considered", 1, 64, "excitation cycles")


class Followed(TypedDict):
    """Keys of a table of trajectories."""

    axes: Axes
    model: NotRequired[Model]
    method: NotRequired[Method]
    methods: NotRequired[
        list_of(Method, "methods; the first one makes the table NAME, each further one a table NAME_METHOD")
    ]
    tolerance: NotRequired[Tolerance]
    step: NotRequired[Step]
    duration: NotRequired[Duration]
