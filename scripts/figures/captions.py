"""Captions of all figures: numbers from the tables that the figures draw, filled into templates."""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from accuracy import speed
from accuracy.reference_check import DIGITS
from accuracy.rigid_part import CONTACT, RIGID
from accuracy.stability import PANELS, VELOCITY
from claims.about_chaos import positive_onset, with_settled_motion
from claims.about_proofs import lowest_fold
from claims.about_states import find_runs, flat_part, format_runs
from claims.finding import onset
from conveyor import NO_FLUCTUATIONS, Hyperbola, critical_height
from excitation import clean_drive
from figures.plots.fig10 import ends_of
from figures.plots.speed_accuracy import method_name
from figures.plots.throw import proved_fold
from figures.style import STATE_COLOURS
from identification import findings
from identification.edges import contacts_of
from operating import drive_page
from operating.chart import spreads_of, summarize_shares
from operating.regimes import CHAOS, NOT_ALL_SETTLED, SEVERAL, SLIDES_AWAY, is_steep
from operating.transit import ENDS
from pipeline.templates import format_number, render

SMALL_ELASTICITY = 1e-3  # below it, a relative error means nothing
TEXTBOOK_AGREES = 0.1  # largest relative difference from the textbook velocity that counts as agreement
SIGNIFICANT = 3.0  # standard errors from zero of an exponent whose sign is certain
VARIANTS = {"rigid": "rigid part", "half": "half the time"}  # of the scene budget


def is_chaotic(spectrum: pd.DataFrame) -> pd.Series:
    """Whether the exponent of each motion is significantly positive."""
    return spectrum.lambda_1 > SIGNIFICANT * spectrum.stderr


def format_change(least: float, most: float) -> str:
    """A range of relative changes (%) in words, "1.1 to 4.2 % below"."""
    if least * most < 0.0:
        return f"between {min(least, most):+.1f} and {max(least, most):+.1f} % off"
    low, high = sorted((abs(least), abs(most)))
    return f"{low:.1f} to {high:.1f} % {'below' if most < 0.0 else 'above'}"


def name_state(state: str) -> str:
    """A state of motion in a sentence: "the first state", "chaos"."""
    return f"the {state} state" if state in ("first", "second") else state


def state_map(*, map: pd.DataFrame) -> dict[str, Any]:
    """The only state of a map, None if there are several, and the share of undecided initial conditions."""
    states = map.state.unique()
    is_one = len(states) == 1 and states[0] != "undecided"
    return {"only": name_state(states[0]) if is_one else None, "undecided": (map.state == "undecided").mean()}


def fig09(*, converged: pd.DataFrame) -> dict[str, Any]:
    decided = converged[converged.state != "undecided"]
    changes = decided.groupby("acceleration").state.agg(lambda state: state.nunique() > 1 and "first" in set(state))
    return {"changes": bool(changes.any()), "undecided": 1.0 - len(decided) / len(converged)}


def fig10(
    *, converged: pd.DataFrame, fit: pd.DataFrame | None = None, euler: pd.DataFrame | None = None
) -> dict[str, Any]:
    found = {
        "found": converged.is_critical.any(),
        "fitted": fit is not None and len(fit) > 0,
        "returns": (~converged.is_critical & (converged.state_above == "first")).any(),
        "highest": ends_of(converged.attrs["scan"])[1],
        "many": (converged.status != "ok").any(),
        "undecided": converged[
            (converged[["state_below", "state_above"]] == "undecided").any(axis=1)
        ].acceleration.nunique(),
        "aside": None,
    }
    if euler is None:
        return found
    both = [edge[edge.is_critical].set_index("acceleration").z0 for edge in (euler, converged)]
    change = 100.0 * (both[0] / both[1] - 1.0).dropna()
    if change.empty:
        return found
    return found | {"aside": format_change(change.max(), change.min()), "most_at": change.idxmin()}


def fit_valley(*, fit: pd.DataFrame) -> dict[str, float]:
    flat = flat_part(fit)
    amplitudes = np.linspace(*fit.attrs["acceleration"], 200)
    heights = [critical_height(amplitudes, Hyperbola(row.A, row.B, row.C)) for row in flat.itertuples()]
    return {"apart": 1e6 * np.ptp(heights, axis=0).max(), "factor": flat.A.max() / flat.A.min()}


def fig17(*, converged: pd.DataFrame) -> dict[str, list[str]]:
    return {"states": [name_state(state) for state in STATE_COLOURS if (converged.state == state).any()]}


def fig22(
    *, converged: pd.DataFrame, spectrum: pd.DataFrame, states: pd.DataFrame, euler: pd.DataFrame | None = None
) -> dict[str, float]:
    settled = with_settled_motion(converged, states)
    positive = settled[settled["lambda"] > 0.0]
    found = {"positive": len(positive), "periodic": int((positive.period > 0).sum())}
    if euler is None:
        return found
    up = spectrum[(spectrum.branch == "up")].sort_values("acceleration", kind="stable")
    joined = pd.merge_asof(
        converged.sort_values("acceleration", kind="stable"),
        up[["acceleration", "lambda_1"]].assign(chaotic=is_chaotic(up)),
        on="acceleration",
        direction="nearest",
    )
    joined = joined[joined.chaotic]
    return found | {
        "lowest_chaos": settled[settled.chaotic].acceleration.min(),
        "euler_positive": positive_onset(euler),
        "converged_positive": positive_onset(converged),
        "plateau": joined["lambda"].median(),
        "truth": joined.lambda_1.median(),
    }


def accumulation(*, spectrum: pd.DataFrame, cascade: pd.DataFrame) -> dict[str, Any]:
    """Where the period doublings accumulate, and where motions are chaotic before it and regular behind it."""
    found = cascade.accumulation.dropna()
    if found.empty:
        return {"accumulation": None}
    place, runs = found.iloc[-1], {}
    for branch, rows in spectrum.sort_values("acceleration", kind="stable").groupby("branch"):
        early = rows[rows.acceleration < place]
        runs[branch] = find_runs(early.acceleration, is_chaotic(early))
    late = spectrum[spectrum.acceleration > place].sort_values("acceleration", kind="stable")
    regular = (late.lambda_1 < -SIGNIFICANT * late.stderr).groupby(late.acceleration).all()
    return {
        "accumulation": place,
        "is_beyond": place > spectrum.acceleration.max(),
        "early_up": format_runs(runs["up"], 2) if runs.get("up") else "nowhere",
        "early_down": format_runs(runs["down"], 2) if runs.get("down") else "nowhere",
        "regular_share": regular.mean(),
    }


def bifurcation(
    *, spectrum: pd.DataFrame, branches: pd.DataFrame, cascade: pd.DataFrame, bifurcations: pd.DataFrame
) -> dict[str, Any]:
    return accumulation(spectrum=spectrum, cascade=cascade) | {
        "orbits": len(branches) > 0,
        "bends": bifurcations.kind.isin(("fold", "period_doubling")).any(),
        "ended": (branches.cycle == 1).sum() >= branches.attrs["most"],
    }


def overview(*, bifurcations: pd.DataFrame, estimate: pd.DataFrame) -> dict[str, float]:
    return {"fold": lowest_fold(bifurcations), "euler_positive": positive_onset(estimate)}


def rigid_part(*, rigid: pd.DataFrame) -> dict[str, float]:
    from_rest = rigid[(rigid.kind == "velocity") & (rigid.z0 == 0.0)].sort_values("acceleration", kind="stable")
    leaves = {model: onset(rows.acceleration, rows.state != "first") for model, rows in from_rest.groupby("model")}
    first = rigid[rigid.kind.isin(("fold", "period doubling")) & (rigid.number == 1)]
    places = first.pivot_table(index="model", columns="kind", values="acceleration")
    later = 100.0 * (places.loc[RIGID] / places.loc[CONTACT] - 1.0)
    return {
        "leaves": leaves[CONTACT],
        "rigid_leaves": leaves[RIGID],
        "fold_later": later["fold"],
        "doubling_later": later["period doubling"],
    }


def scene_budget(*, budget: pd.DataFrame) -> dict[str, pd.Series]:
    """Whether a variant differs visibly from the full model, for each table."""
    rows = budget.drop_duplicates(["table", "variant", "tolerance"])
    return {name: rows[rows.variant == variant].visible for name, variant in VARIANTS.items()}


def speed_accuracy(
    *,
    jumping: pd.DataFrame,
    jumping_times: pd.DataFrame,
    reference: pd.DataFrame,
    paper_step: float,
    equal_error: float,
) -> dict[str, Any]:
    runs = speed.successful_runs(jumping, jumping_times)
    paper, *others = speed.factors(runs, paper_step, equal_error)
    difference = reference.difference.abs().max()
    return {
        "paper_run": paper,
        "rival": others[0] if others else None,
        "rival_name": method_name(others[0].method) if others else None,
        "missing": list(jumping[jumping.outcome == "not installed"].method.unique()),
        "difference": difference,
        "digits": DIGITS,
        "agreeing": int(-np.log10(difference)),
    }


def stability_limits(*, stability: pd.DataFrame) -> dict[str, Any]:
    own = stability[(stability.method == "event") & stability.panel.isin(PANELS)]
    return {"accuracy": VELOCITY, "own_right": own.outcome == "right"}


def sensitivity(
    *, derivatives: pd.DataFrame, continued: pd.DataFrame, meetings: pd.DataFrame, bifurcations: pd.DataFrame
) -> dict[str, Any]:
    right = derivatives[derivatives.status == "ok"]
    error = ((right.derivative - right.difference) / right.derivative).abs()[right.elasticity.abs() > SMALL_ELASTICITY]
    own = continued[continued.parameter == "angle"]
    first = continued[continued.kind == "fold"].begin.min()
    cusps = meetings[(meetings.begin == first) & (meetings.meeting == "cusp") & (meetings.parameter == "damping")]
    short = bifurcations[bifurcations.period <= derivatives.attrs["longest_period"]]
    return {
        "many": (short.kind.value_counts() > derivatives.attrs["most"]).any(),
        "heights": list(map(format_number, right[right.kind == "critical_height"].acceleration.unique())),
        "tried": (derivatives.kind == "critical_height").any(),
        "right": np.isfinite(error.max()),
        "points": (derivatives.kind != "critical_amplitude").any(),
        "has_fold": not np.isnan(first),
        "error": error.max(),
        "failed": (derivatives.derivative.notna() & (derivatives.status != "ok")).sum(),
        "missing": derivatives.derivative.isna().sum(),
        "own": own.iloc[0].to_dict() if len(own) else {},
        "cusps": list(cusps[cusps.status == "ok"].damping_group.sort_values()),
    }


def throw(*, throws: pd.DataFrame, bifurcations: pd.DataFrame) -> dict[str, Any]:
    jumps = throws[(throws.state == "second") & (throws.vertical < 1.0)].groupby("conveyor", sort=False).vertical.min()
    most = throws.loc[throws.groupby(["conveyor", "vertical"], sort=False).share.idxmax()]
    most = most[(most.vertical > 1.0) & most.textbook.notna()]
    close = (most.mean_velocity - most.textbook).abs() <= TEXTBOOK_AGREES * most.textbook
    fold = proved_fold(throws, bifurcations)
    return {
        "jumps": jumps.to_dict(),
        "fold": None if np.isnan(fold) else fold,
        "within": TEXTBOOK_AGREES,
        "agree": close.groupby(most.conveyor, sort=False).agg(["sum", "count"]).to_dict("index"),
    }


def track(*, track: pd.DataFrame) -> dict[str, Any]:
    steepest = track[(track.mean_velocity > 0.0) & (track.inclination > 0.0)].groupby("state").inclination.max()
    is_open = track.status == NOT_ALL_SETTLED
    known = track[~is_open & (track.status != SLIDES_AWAY)]
    is_reached = (known.status == "ok").groupby(known.state)
    return {
        "steepest": np.degrees(steepest).to_dict(),
        "steep": (track.status == SLIDES_AWAY).any(),
        "missing": [state for state, all_reach in is_reached.all().items() if not all_reach],
        "absent": [state for state, any_reach in is_reached.any().items() if not any_reach],
        "unsettled": track[is_open].inclination.nunique() / track.inclination.nunique(),
        "empty": track.mean_velocity.isna().all(),
    }


def identification(*, frictions: pd.DataFrame) -> dict[str, Any]:
    settings = frictions.attrs
    return {
        "contacts": contacts_of(settings["effort"]) ** 2,
        "coarse": settings["effort"] < findings.ENOUGH,
        "accepted": findings.accepted_frictions(frictions, settings["numbers"]),
    }


def harmonics(*, drives: pd.DataFrame) -> dict[str, Any]:
    limits = drives.attrs["statement"]
    harmless = clean_drive.harmless_shares(drives, drives.attrs["matters"])
    return {
        "statement": clean_drive.statement_of(drives),
        "limits": limits,
        "ends": ENDS,
        "harmless": harmless.replace({np.nan: None}).to_dict("records"),
    }


def transit(*, transit: pd.DataFrame, lengths: pd.DataFrame, drift: pd.DataFrame) -> dict[str, Any]:
    amplitudes = {
        regime: list(map(format_number, rows.acceleration.unique())) for regime, rows in lengths.groupby("regime")
    }
    return {
        "search": transit.attrs,
        "backwards": transit.sort_values("back", na_position="first", kind="stable").iloc[-1].to_dict(),
        "spread": spreads_of(transit.attrs),
        "calibrated": transit.attrs["spread"].get("calibrated", False),
        "coexisting": amplitudes.get(SEVERAL, []),
        "chaotic": amplitudes.get(CHAOS, []),
        "uncertain": int((~drift.status.isin(("ok", NO_FLUCTUATIONS))).sum()),
        "spreads": bool((lengths.spread > 0.0).any()),
        "ends": ENDS,
        "middle": ENDS[1] - ENDS[0],
    }


# Functions of the captions whose templates need more than the tables and settings of their figures.
NUMBERS: dict[str, Callable[..., dict[str, Any]]] = {
    "fig09": fig09,
    "fig10": fig10,
    **dict.fromkeys(("fig12", "fig13", "fig14", "fig18", "fig19"), state_map),
    "fig17": fig17,
    "fig22": fig22,
    "fit_valley": fit_valley,
    "harmonics": harmonics,
    "identification": identification,
    "overview": overview,
    "bifurcation": bifurcation,
    "sensitivity": sensitivity,
    "basin_stability": summarize_shares,
    "operating": summarize_shares,
    "rigid_part": rigid_part,
    "scene_budget": scene_budget,
    "throw": throw,
    "drive": drive_page.summarize_search,
    "track": track,
    "transit": transit,
    "speed_accuracy": speed_accuracy,
    "stability": stability_limits,
}


def caption(template: str, name: str, tables: dict[str, pd.DataFrame], settings: dict, paper: bool = True) -> str:
    """The caption of a figure from its template, tables and settings, and the numbers of its function in NUMBERS.

    `paper` says whether the figure shows the paper's conveyor.

    Raises
    ------
    jinja2.UndefinedError
        if the template uses a value that is in none of them
    """
    values = {**tables, **settings}
    numbers = {}
    if function := NUMBERS.get(name):
        parameters = inspect.signature(function).parameters
        numbers = function(**{name: values[name] for name in parameters if name in values})
    conveyor = "the paper's conveyor" if paper else "this conveyor"
    models = [table.attrs["model"] for table in tables.values() if "friction" in table.attrs.get("model", {})]
    about = {"paper": paper, "conveyor": conveyor, "slides": any(map(is_steep, models))}
    return render(template, values | numbers | about)


def make(
    figures: dict[str, dict], paper: bool, references: list[str], read: list[pd.DataFrame], templates: list[str]
) -> list[str]:
    """The captions of all figures, in order.

    Parameters
    ----------
    figures : entries of the config
    paper : whether the figures show the paper's conveyor
    references, read : names of the tables, SECTION/NAME, and the tables
    templates : one per figure
    """
    tables_by_name = dict(zip(references, read, strict=True))
    captions = []
    for (name, entry), template in zip(figures.items(), templates, strict=True):
        roles = {**entry["tables"], **entry.get("caption_tables", {})}
        tables = {role: tables_by_name[reference] for role, reference in roles.items()}
        captions.append(caption(template, name, tables, entry.get("settings", {}), paper))
    return captions
