"""Parquet tables: every schema in one place, atomic writing of equal bytes for equal content, checked reading.

A table has the columns of its axes first, then those of its kind. Units stand in the metadata of the fields. What was
computed (model, duration, method, …) stands in the metadata of the table; pandas.read_parquet shows it as `attrs`.
"""

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from .model import PARAMETERS, TENSION, UNITS

# Rows of a row group: fixed, so that a table's bytes do not depend on how it was computed.
ROW_GROUP = 1 << 20
# The key under which pandas keeps DataFrame.attrs.
SETTINGS = b"PANDAS_ATTRS"


def field(name: str, kind: pa.DataType, unit: str, description: str) -> pa.Field:
    """One column; dimensionless ones have the unit "1", texts none."""
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


AXES = {name: number(name, UNITS[name], "axis of the sweep") for name in PARAMETERS}
AXES["z0"] = number("z0", UNITS["z0"], "axis of the sweep; null for a start on the conveyor (Eq. 15)")
AXES[PARAMETERS[TENSION]] = text(PARAMETERS[TENSION], "axis of the sweep")

RESULTS = (
    number("mean_velocity", "m/s", "mean feeding velocity over the last quarter; null for vertical needs"),
    number("z_end", "m", "height of the part at the end"),
    number("vz_end", "m/s", "vertical velocity of the part at the end"),
    number("x_end", "m", "horizontal position of the part at the end; null for vertical needs"),
    number("vx_end", "m/s", "horizontal velocity of the part at the end; null for vertical needs"),
)
STATE = (
    text("state", "state of motion that the run leads to: first, second, chaos, undecided"),
    count("period", "period of that motion in excitation cycles; 0 for none"),
)
FEATURES = (
    number("max_gap", "m", "largest distance between part and plate"),
    count("impacts", "number of impacts"),
    number("contact_fraction", "1", "share of the duration with a contact force"),
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
    number("multiplier_1_imag", "1", "imaginary part"),
    number("multiplier_2_real", "1", "the other one, real part"),
    number("multiplier_2_imag", "1", "imaginary part"),
    number("determinant", "1", "their product, from the monodromy matrix; exp(-(d_c/m) contact_time)"),
    number("contact_time", "s", "time with contact force in a period"),
    count("impacts", "impacts in a period"),
    number("longest_flight", "1", "longest flight, in excitation cycles"),
)


def ends(name: str, unit: str, description: str) -> tuple[pa.Field, pa.Field]:
    """Two columns: the ends of an interval that holds a number by proof, rounded outwards."""
    return (
        number(f"{name}_low", unit, f"{description}: no larger than it, by proof; null where nothing is proved"),
        number(f"{name}_high", unit, f"{description}: no smaller than it, by proof"),
    )


ARITHMETIC = (
    count("bits", "bits of the arithmetic"),
    count("order", "order of the Taylor series"),
)

RUN = (
    text("method", "event, a fixed-step method, or one of scipy's integrators"),
    text(
        "treatment",
        "of impacts and slip reversals: exact, with or without repeated steps, fixed step, sign, events or modes",
    ),
    number("tolerance", "1", "relative tolerance; null for fixed steps"),
    number("step", "s", "step; null for tolerances"),
)

# The columns behind the axes, by kind of table.
COLUMNS = {
    "branches": (
        count("branch", "number of the branch"),
        count("point", "number of the orbit along its branch"),
        count("cycle", "excitation cycle within the period; delta and v are those at its end"),
        flag("stable", "both multipliers inside the unit circle"),
        *ORBIT,
    ),
    "folds_and_doublings": (
        text("kind", "fold, period_doubling or grazing"),
        *ORBIT[:2],
        number("multiplier", "1", "the multiplier at +1 or -1; for a grazing the real part of the larger one"),
        *ORBIT[2:],
        count("branch", "number of the branch"),
    ),
    "cascade": (
        count("number", "number of the doubling"),
        *ORBIT,
        number("multiplier", "1", "the multiplier at -1"),
        number("ratio", "1", "distance to the doubling before over that to the one behind (Feigenbaum: 4.669…)"),
        number("accumulation", "m/s²", "where the doublings so far accumulate, by Aitken's process"),
        number("accumulation_error", "m/s²", "how far the last doubling moved it"),
    ),
    "certificates": (
        count("branch", "number of the branch; those above the stored ones are longer orbits of the cascade"),
        count("period", "excitation cycles; the least period, if the orbit is proved"),
        number("acceleration", "m/s²", "amplitude of the excitation, the decimal that is written"),
        flag("contained", "whether exactly one orbit is proved in a box around the stored one"),
        text("reason", "why not; null where it is"),
        text("stability", "proved: stable or unstable; else open"),
        count("impacts", "impacts in a period, proved if the orbit is"),
        number(
            "stored_delta",
            "m",
            "penetration at the phase ψ0 of the orbit in floating point, found from the stored ones",
        ),
        number("stored_v", "m/s", "its speed of approach there"),
        *ends("delta", "m", "penetration at the phase ψ0"),
        *ends("v", "m/s", "speed of approach at the phase ψ0"),
        *ends("impact_phase", "rad", "phase of the first impact after it"),
        *ends("impact_speed", "m/s", "speed of approach at the first impact"),
        *ends("duration", "s", "the period"),
        *ends("contact_time", "s", "time with contact force in a period"),
        *ends("trace", "1", "sum of the Floquet multipliers"),
        *ends("determinant", "1", "their product, exp(-(d_c/m) contact_time)"),
        *ends("multiplier_1_real", "1", "multiplier of larger modulus, real part; null where it is open which that is"),
        *ends("multiplier_1_imag", "1", "imaginary part"),
        *ends("multiplier_2_real", "1", "the other one, real part"),
        *ends("multiplier_2_imag", "1", "imaginary part"),
        number("half_width", "1", "largest half-width of an enclosure of a state, in g/ω² and g/ω"),
        number("distance", "1", "of the stored orbit from the enclosed one, in g/ω² and g/ω"),
        *ARITHMETIC,
    ),
    "certified_bifurcations": (
        text("kind", "fold or period_doubling"),
        count("number", "number of its kind"),
        count("period", "excitation cycles of the orbit that folds or doubles"),
        flag("proved", "whether it is"),
        text("reason", "why not; null where it is"),
        number("stored_acceleration", "m/s²", "amplitude that was computed in floating point"),
        *ends("acceleration", "m/s²", "amplitude of the bifurcation"),
        *ends(
            "test_begin",
            "1",
            "(1 ∓ μ1)(1 ∓ μ2) of a fold (-) or doubling (+) at the lower amplitude or first end of the arc",
        ),
        *ends("test_end", "1", "the same at the higher amplitude or the other end"),
        *ARITHMETIC,
    ),
    "certified_chaos": (
        number("acceleration", "m/s²", "amplitude of the excitation, the decimal that is written"),
        flag("proved", "whether covering relations that make chaos are proved"),
        text("reason", "why not; null where they are"),
        count("sets", "parallelograms; an excursion from the first one and back takes as many excitation cycles"),
        number("entropy", "1", "topological entropy per excitation cycle: no larger than it, by proof"),
        number("delta", "m", "penetration at the phase ψ0 of the orbit of one cycle in the first parallelogram"),
        number("v", "m/s", "its speed of approach there"),
        *ARITHMETIC,
    ),
    "certificate_times": (
        text("kind", "table of what was proved"),
        number("acceleration", "m/s²", "amplitude of the excitation"),
        count("period", "excitation cycles"),
        count("impacts", "impacts in a period"),
        number("seconds", "s", "wall time; it differs from run to run"),
    ),
    "strobes": (
        text("branch", "up: the amplitude grew step by step; down: it fell"),
        ORBIT[1],
        count("cycle", "number of the recorded cycle"),
        *STROBE,
        *STATE,
        text("status", "ok, or why there is no result"),
    ),
    "spectrum": (
        ORBIT[1],
        text("branch", "up or down, see the strobes"),
        number("lambda_1", "1/s", "larger vertical Lyapunov exponent"),
        number("lambda_2", "1/s", "smaller vertical Lyapunov exponent"),
        number("stderr", "1/s", "standard error of lambda_1, from means over blocks"),
        number("contact_fraction", "1", "share of the time with contact force; λ1 + λ2 = -(d_c/m) times it"),
        text("status", "ok, or why there is no result"),
    ),
    "witnesses": (
        ORBIT[1],
        text("branch", "up or down, see the strobes"),
        number("lambda_1", "1/s", "larger vertical Lyapunov exponent"),
        number("stderr", "1/s", "its standard error"),
        number("zero_one", "1", "K of the 0-1 test: 0 for regular, 1 for chaotic motion"),
        *STATE,
        flag("by_exponent", "chaotic by the exponent"),
        flag("by_zero_one", "chaotic by the 0-1 test"),
        flag("by_period", "chaotic for want of a period"),
        flag("agree", "whether the three agree"),
        text("reason", "why not; null where they agree"),
    ),
    "runs": RESULTS + FEATURES,
    "sweeps": (
        *RESULTS,
        *STATE,
        *FEATURES,
        number(
            "longest_flight", "1", "of that motion, in excitation cycles; tells motions of one state apart; else null"
        ),
    ),
    "estimates": (number("lambda", "1/s", "Lyapunov exponent by finite differences (Eq. 23)"),),
    "signals": (
        *STATE,
        number("time", "s", "time since the start"),
        number("x", "m", "horizontal position of the part"),
        number("vx", "m/s", "horizontal velocity of the part"),
        number("z", "m", "height of the part"),
        number("vz", "m/s", "vertical velocity of the part"),
        number("contact_force", "N", "force of the plate on the part, vertical (Eq. 9)"),
        number("friction_force", "N", "force of the plate on the part, horizontal (Eq. 11)"),
        number("plate_x", "m", "horizontal position of the plate"),
        number("plate_vx", "m/s", "horizontal velocity of the plate (Eq. 10)"),
        number("plate_z", "m", "height of the plate (Eq. 4)"),
        number("plate_vz", "m/s", "vertical velocity of the plate (Eq. 3)"),
    ),
    "spectra": (
        text("signal", "velocity of the part: vx or vz"),
        number("frequency", "Hz", "frequency"),
        number("amplitude", "m/s", "one-sided amplitude; at frequency 0 the modulus of the mean value"),
        count("main_lobe", "bins on either side over which a line spreads; 0 for harmonics of a periodic motion"),
    ),
    "impacts": (
        number("impact_time", "s", "time of the first impact (Eq. 16); null for a start below the plate's surface"),
        number("impact_velocity", "m/s", "vertical velocity of the part then (Eq. 17)"),
        number("impact_phase", "rad", "phase of the excitation then (Eq. 18), not wrapped"),
        text("state", "state of motion that the start leads to"),
        text(
            "mapped_state", "state that a start on the plate with this phase and velocity leads to; null without impact"
        ),
    ),
    "critical": (
        number("z0", "m", "initial height at which the state of motion changes"),
        count("crossing", "number of the change at this conveyor, from below, 1 the first"),
        text("state_below", "state of motion that starts just below lead to"),
        text("state_above", "state of motion that starts just above lead to"),
        flag("is_critical", "the lowest change out of the first state"),
    ),
    "regressions": (
        text("fit", "pymoo, least_squares, paper (the paper's own triple) or valley (the best A and C for a given B)"),
        number("A", "m²/s²", "parameter of Eq. 13"),
        number("B", "m/s²", "parameter of Eq. 13"),
        number("C", "m", "parameter of Eq. 13"),
        number("error", "m²", "mean squared error of Eq. 13"),
        count("evaluations", "number of triples, or of values of B, whose error was computed; 0 for given triples"),
    ),
    "dimensions": (
        number(
            "dimension",
            "1",
            "fractal dimension of the phase portrait ż_p over z_p (Eq. 25); null where nothing is known",
        ),
        number("error", "1", "half-width of its 95 % interval; null where the points resolve too few scales"),
        number("scale_low", "1", "smallest scale of the scaling region, in units of the portrait's extent"),
        number("scale_high", "1", "largest scale of the scaling region, in units of the portrait's extent"),
        text("status", "ok, or why there is no dimension"),
    ),
    "settling_times": (
        number("acceleration", "m/s²", "amplitude of the excitation"),
        number("z0", "m", "initial height"),
        number("psi0", "rad", "phase of the excitation at the start"),
        *STATE,
        count(
            "cycles", "excitation cycles for which the start was followed: until it settled, or as long as asked for"
        ),
    ),
    "random_points": (
        text("drawn", "around the paper or over the whole ranges"),
        number("duration", "s", "length of the run"),
        *RESULTS,
        *FEATURES,
        number("max_depth", "m", "largest penetration at the moments that were looked at"),
        number("allowed_depth", "m", "penetration that no run can exceed"),
    ),
    "claims": (
        text("id", "name of the statement"),
        text("where", "where the paper makes it"),
        text("statement", "what it says"),
        several("quantities", pa.string(), "", "what its numbers are, with units"),
        several("paper", pa.float64(), "see quantities", "the paper's numbers; null where it gives none"),
        several(
            "paper_method",
            pa.float64(),
            "see quantities",
            "by the paper's method, computed here; empty where it has no say",
        ),
        several("converged", pa.float64(), "see quantities", "converged; empty where the statement is on Euler"),
        several("accepted_low", pa.float64(), "see quantities", "least numbers that bear it out; null for none"),
        several("accepted_high", pa.float64(), "see quantities", "largest ones; null for none"),
        several("because", pa.string(), "", "why the accepted numbers are these"),
        text("verdict", "reproduced, reproduced by the paper's method only, or not reproduced"),
        text("reason", "computed reason of any other verdict than reproduced; else a note, null for none"),
    ),
    "precision": (
        *RUN,
        count("evaluations", "force evaluations that are computed; derivatives of the force for a Taylor step"),
        count("repeated_evaluations", "those of a settled motion that are used again instead"),
        number("mean_velocity", "m/s", "mean feeding velocity over the last quarter"),
        number("velocity_error", "1", "its relative error"),
        number("state_error", "1", "largest error of ẋ, z, ż at the end, in units of the plate's motion"),
        text("outcome", "ok, or what is wrong, whatever the run itself reports"),
    ),
    "wall_times": (
        *RUN,
        number("seconds", "s", "median wall time"),
        count("repeats", "timed runs"),
    ),
    "estimators": (
        text("quantity", "exponent, dimension or fit"),
        text("estimator", "how it is estimated"),
        number("work", "1", "simulated cycles, points or evaluations"),
        number("error", "1", "relative error of the exponent; error of the dimension; relative gap to the best fit"),
    ),
    "stability": (
        text(
            "panel", "stiffness, damping, impact velocity, conveyor; edge of one of them; chatter; or hard and a case"
        ),
        text("method", "euler, semi_implicit_euler, rk4 or event"),
        number("x", "see panel", "step in s; hard: number of events"),
        number(
            "y",
            "see panel",
            "stiffness in N/m, damping in N s/m, velocity in m/s, conveyor: amplitude in m/s²; chatter: slip in m/s; "
            "hard: relative error of the height at the end",
        ),
        text("outcome", "right, wrong state, energy grows or blow-up"),
        number("theory", "s", "largest stable step in theory; null where there is none"),
    ),
    "stability_estimates": (
        text("panel", "what is varied: perturbation, time or step; known set, samples or run time"),
        text("case", "motion or set"),
        text("estimator", "event or euler for exponents; boxes, boxes as in the paper, or correlation sum"),
        number("epsilon", "rad or m", "perturbation of the phase or of the initial height; null for dimensions"),
        number("duration", "s", "time of the run; null for points of known sets and settled portraits"),
        number("step", "s", "step of Euler; null for dimensions"),
        number("samples", "1", "number of points; null for exponents"),
        number("value", "1/s or 1", "the estimate: an exponent in 1/s, or a dimension"),
        number("error", "1", "half-width of its 95 % interval; null for exponents"),
        number("truth", "1/s or 1", "what it should be; null where nobody knows"),
        number("bound", "1/s", "estimate of a pair that is as far apart as the signal goes; null for dimensions"),
    ),
    "scene_budget": (
        text("figure", "figure of the config"),
        text("table", "table that it draws, SECTION/NAME; none for a drawing"),
        text("needs", "feeding or vertical motion, or nothing"),
        text("shows", "what the figure shows of the table"),
        flag("settled", "whether that is of the motion that a start ends in, not of the way there"),
        text("variant", "full model, feeding or vertical needs, half the time, rigid part, or drawing"),
        number("tolerance", "1", "relative error of a step; null where there is none"),
        number("duration", "s", "length of the runs; null where they last until they settle"),
        count("points", "points of the table that were computed"),
        number("steps", "1/s", "Taylor steps in a second of the motion; null for the rigid part"),
        number("sticks", "1", "share of the points whose part sticks at some time"),
        number("known", "1", "share of the drawn values that a tiny shift of the start does not change visibly"),
        number("changed", "1", "share of those that differ visibly from the full model's, the worst of the columns"),
        flag("visible", "whether a reader would see the difference"),
        flag("chosen", "whether this is what the config chooses"),
        text("reason", "why the choice is tighter than the picture needs; null where it is not"),
    ),
    "budget_times": (
        text("table", "table that a figure draws, SECTION/NAME"),
        text("variant", "as in the table of budgets"),
        number("tolerance", "1", "relative error of a step; null where there is none"),
        number("seconds", "s", "wall time of a point on one core"),
        number("full_seconds", "s", "wall time of a point of the full model at tight tolerance"),
        number("ratio", "1", "the latter over the former"),
    ),
    "rigid_part": (
        text("model", "contact, or a rigid part whose restitution depends on the speed of approach or is one number"),
        text("kind", "velocity, fold or period doubling"),
        count("number", "number of the bifurcation from below; 0 for velocities"),
        number("acceleration", "m/s²", "amplitude of the excitation"),
        number("z0", "m", "initial height; null for bifurcations"),
        number("mean_velocity", "m/s", "mean feeding velocity over the last quarter; null for bifurcations"),
        text("state", "first, second, chaos or undecided; null for bifurcations"),
    ),
    "benchmark": (
        text("case", "name of the case"),
        text("motion", "what the part does"),
        text(
            "chosen", "which tolerance this is: default, or the loosest that keeps the error, chosen against the truth"
        ),
        number("tolerance", "1", "relative error of a step"),
        number("acceleration", "m/s²", "amplitude of the excitation"),
        number("z0", "m", "initial height"),
        number("duration", "s", "length of the timed runs"),
        number("compared", "s", "length of the runs whose mean velocities are compared"),
        number("mean_velocity", "m/s", "mean feeding velocity, from an independent integration"),
        number("error", "1", "relative error of the solver's mean velocity"),
        number("euler_error", "1", "relative error of Euler's mean velocity"),
        count("steps", "Taylor steps that a timed run computes"),
        count("repeated_steps", "Taylor steps of a settled motion that it repeats"),
        count("evaluations", "derivatives of the contact force in a timed run"),
        count("events", "events of a timed run"),
        count("euler_steps", "steps of Euler in a timed run"),
        number("seconds", "s", "median wall time of the solver"),
        number("seconds_without", "s", "the same if every step is computed"),
        number("euler_seconds", "s", "median wall time of Euler"),
        number("speed", "1", "wall time of Euler over that of the solver"),
        number("speed_without", "1", "the same if every step is computed"),
        count("repeats", "rounds of timed runs"),
    ),
}


def schema(kind: str, axes: Sequence[str] = ()) -> pa.Schema:
    """Schema of a table of a kind of COLUMNS with the given axes."""
    return pa.schema([*(AXES[name] for name in axes), *COLUMNS[kind]])


def make(kind: str, columns: Mapping[str, np.ndarray], axes: Sequence[str], settings: dict) -> pa.Table:
    """The table that `write` writes."""
    wanted = schema(kind, axes)
    if difference := set(wanted.names) ^ set(columns):
        raise ValueError(f"columns of a table of {kind}: {', '.join(sorted(difference))} lacking or unknown")
    arrays = []
    for column in wanted:
        try:
            values = columns[column.name]
            if pa.types.is_floating(column.type):
                values = np.asarray(values, dtype=np.float64) + 0.0  # no negative zero
            arrays.append(pa.array(values, type=column.type, from_pandas=True))
        except (pa.ArrowInvalid, pa.ArrowTypeError) as error:
            raise ValueError(f"column {column.name} of a table of {kind} is not {column.type}: {error}") from error
    metadata = {SETTINGS: json.dumps(settings)}
    return pa.Table.from_arrays(arrays, schema=wanted.with_metadata(metadata))


def write(
    path: str | Path, kind: str, columns: Mapping[str, np.ndarray], *, axes: Sequence[str] = (), settings: dict
) -> None:
    """Write a table to `path` at once or not at all; its bytes depend on its content and on pyarrow's version only.

    Parameters
    ----------
    path : of the file; its folder exists
    kind : one of COLUMNS
    columns : by name, in any order, all of shape (n,); NaN becomes null
    axes : names of the axes, which come first
    settings : what was computed, as JSON can write it

    Raises
    ------
    ValueError
        names the columns that lack, are too many or do not fit their type
    """
    path = Path(path)
    part = path.with_name(f"{path.name}.part")
    table = make(kind, columns, axes, settings)
    pq.write_table(table, part, compression="zstd", row_group_size=ROW_GROUP)
    os.replace(part, path)


def read(path: str | Path, kind: str) -> pd.DataFrame:
    """The table at `path`, its settings in `attrs`.

    Raises
    ------
    ValueError
        if its columns, types or units are not those of its kind
    """
    found = pq.read_schema(path).remove_metadata()
    axes = found.names[: -len(COLUMNS[kind])]
    if not set(axes) <= set(AXES) or not found.equals(schema(kind, axes), check_metadata=True):
        raise ValueError(f"{path} is not a table of {kind}: it has the columns {', '.join(found.names)}")
    return pd.read_parquet(path)
