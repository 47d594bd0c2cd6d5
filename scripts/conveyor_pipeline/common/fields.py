"""Columns of tables: constructors, columns of axes, and groups of columns that several stages share.

The schema of a table is in the module of its stage, next to the function that makes it.
"""

from collections.abc import Mapping, Sequence

import pyarrow as pa

from conveyor import PARAMETERS, UNITS


def field(name: str, kind: pa.DataType, unit: str, description: str) -> pa.Field:
    """A column with its unit, "1" for dimensionless numbers, "" for texts."""
    return pa.field(name, kind, metadata={"unit": unit, "description": description})


def number(name: str, unit: str, description: str) -> pa.Field:
    return field(name, pa.float64(), unit, description)


def count(name: str, description: str) -> pa.Field:
    return field(name, pa.int64(), "1", description)


def text(name: str, description: str) -> pa.Field:
    return field(name, pa.string(), "", description)


def several(name: str, kind: pa.DataType, unit: str, description: str) -> pa.Field:
    """A column of lists."""
    return field(name, pa.list_(pa.field("element", kind)), unit, description)


def flag(name: str, description: str) -> pa.Field:
    return field(name, pa.bool_(), "", description)


def columns(rows: Sequence[Mapping], schema: Sequence[pa.Field]) -> dict[str, list]:
    """The columns of a schema from rows; other entries of the rows are ignored."""
    return {column.name: [row[column.name] for row in rows] for column in schema}


AXES = {name: number(name, UNITS[name], "axis of the sweep") for name in PARAMETERS}
AXES["z0"] = number("z0", UNITS["z0"], "axis of the sweep; null for an initial position on the conveyor (Eq. 15)")
AXES["tension"] = text("tension", "axis of the sweep")

ENDS = (
    number("z_end", "m", "height of the part at the end"),
    number("vz_end", "m/s", "vertical velocity of the part at the end"),
    number("x_end", "m", "horizontal position of the part at the end; null for vertical needs"),
    number("vx_end", "m/s", "horizontal velocity of the part at the end; null for vertical needs"),
)
RESULTS = (
    number("mean_velocity", "m/s", "mean feeding velocity over the last quarter; null for vertical needs"),
    *ENDS,
)
STATE = (
    text("state", "state of motion: first, second, chaos or undecided"),
    count("period", "period of this motion in excitation cycles; 0 for none"),
)
FEATURES = (
    number("max_gap", "m", "largest distance between part and plate"),
    count("impacts", "number of impacts"),
    number("contact_fraction", "1", "share of the duration with a contact force"),
    number("impact_speed", "m/s", "largest speed of approach at an impact over the last quarter; 0 if there is none"),
    number("peak_force", "N", "largest contact force over the last quarter; 0 if there is none"),
    text("status", "ok, or why there is no result"),
)

STROBE = (
    number("delta", "m", "penetration at the phase ψ0; negative in the air"),
    number("v", "m/s", "speed of approach at the phase ψ0"),
)
ORBIT = (
    count("period", "excitation cycles"),
    number("acceleration", "m/s²", "amplitude of the excitation"),
    *STROBE,
    number("multiplier_1_real", "1", "Floquet multiplier of larger modulus, real part"),
    number("multiplier_1_imag", "1", "Floquet multiplier of larger modulus, imaginary part"),
    number("multiplier_2_real", "1", "Floquet multiplier of smaller modulus, real part"),
    number("multiplier_2_imag", "1", "Floquet multiplier of smaller modulus, imaginary part"),
    number(
        "determinant",
        "1",
        "product of the multipliers, from the monodromy matrix unless rounding hides it; exp(-(d_c/m) contact_time)",
    ),
    number("contact_time", "s", "time with contact force in a period"),
    count("impacts", "impacts in a period"),
    number("longest_flight", "1", "longest flight, in excitation cycles"),
)
