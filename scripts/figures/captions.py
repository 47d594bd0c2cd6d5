"""Captions of all figures: numbers from the tables that the figures draw, filled into templates."""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from accuracy import speed
from accuracy.rigid_part import CONTACT, RIGID
from accuracy.stability import PANELS, VELOCITY
from claims.about_chaos import positive_onset
from claims.about_states import find_runs, format_runs, second_from_rest
from claims.finding import lowest
from figures.plots.throw import proved_fold
from identification import findings
from operating import drive_page
from operating.chart import summarize_shares
from pipeline.templates import render

MM = 1e3
SMALL_ELASTICITY = 1e-3  # below it, a relative error means nothing
TEXTBOOK_AGREES = 0.1  # largest relative difference from the textbook velocity that counts as agreement
SIGNIFICANT = 3.0  # standard errors from zero of an exponent whose sign is certain


def format_power(value: float) -> str:
    """A small number in one digit, "1e-9"."""
    return f"{value:.0e}".replace("e-0", "e-")


def heights(table: pd.DataFrame) -> dict[str, str]:
    """Number and range of the initial heights of a sweep."""
    z0 = np.sort(table.z0.unique())
    return {"heights": str(len(z0)), "lowest_mm": f"{MM * z0[0]:g}", "highest_mm": f"{MM * z0[-1]:g}"}


def run_numbers(table: pd.DataFrame) -> dict[str, str]:
    """Duration of the runs of a table (s), and their time step (µs) if they have a fixed one."""
    numbers = {"duration": f"{table.attrs['duration']:g}"}
    return numbers | ({"step_us": f"{1e6 * table.attrs['step']:g}"} if "step" in table.attrs else {})


def is_chaotic(spectrum: pd.DataFrame) -> pd.Series:
    """Whether the exponent of each motion is significantly positive."""
    return spectrum.lambda_1 > SIGNIFICANT * spectrum.stderr


def fig03(*, converged: pd.DataFrame, euler: pd.DataFrame | None = None) -> dict[str, str]:
    return run_numbers(converged if euler is None else euler)


def fig08(*, converged: pd.DataFrame) -> dict[str, str]:
    return heights(converged)


def format_change(least: float, most: float) -> str:
    """A range of relative changes (%) in words, "1.1 to 4.2 % below"."""
    if least * most < 0.0:
        return f"between {min(least, most):+.1f} and {max(least, most):+.1f} % off"
    low, high = sorted((abs(least), abs(most)))
    return f"{low:.1f} to {high:.1f} % {'below' if most < 0.0 else 'above'}"


def fig10(*, converged: pd.DataFrame, euler: pd.DataFrame | None = None) -> dict[str, str]:
    numbers = {"resolution": f"{converged.attrs['resolution']:g}"}
    if euler is None:
        return numbers
    both = [edge[edge.is_critical].set_index("acceleration").z0 for edge in (euler, converged)]
    change = 100.0 * (both[0] / both[1] - 1.0).dropna()
    return numbers | {
        "aside": format_change(change.max(), change.min()),
        "most_at": f"{change.idxmin():g}",
    }


def fig20(*, converged: pd.DataFrame) -> dict[str, str]:
    attributes = converged.attrs
    first = attributes["model"]["z0"]
    return {"first_mm": f"{MM * first:g}", "second_mm": f"{MM * (first + attributes['epsilon']):g}"}


def fig22(*, converged: pd.DataFrame, spectrum: pd.DataFrame, euler: pd.DataFrame | None = None) -> dict[str, str]:
    numbers = {"epsilon": format_power(converged.attrs["epsilon"])}
    if euler is None:
        return numbers
    up = spectrum[(spectrum.branch == "up")].sort_values("acceleration")
    joined = pd.merge_asof(
        converged.sort_values("acceleration"),
        up[["acceleration", "lambda_1"]].assign(chaotic=is_chaotic(up)),
        on="acceleration",
        direction="nearest",
    )
    joined = joined[joined.chaotic]
    return numbers | {
        "euler_positive": f"{positive_onset(euler):g}",
        "converged_positive": f"{positive_onset(converged):g}",
        "plateau": f"{joined['lambda'].median():.0f}",
        "truth": f"{joined.lambda_1.median():.0f}",
    }


def fig23(*, converged: pd.DataFrame) -> dict[str, str]:
    return {"end": f"{converged.time.max():g}"}


def fig24(*, converged: pd.DataFrame) -> dict[str, str]:
    return {
        "unknown": str(int(converged.dimension.isna().sum())),
        "amplitudes": str(len(converged)),
        "largest_error": f"{converged.attrs['largest_error']:g}",
    }


def bifurcation(*, spectrum: pd.DataFrame, cascade: pd.DataFrame, longest_period: int) -> dict[str, str]:
    found = cascade.accumulation.dropna()
    if found.empty:
        return {"longest_period": str(longest_period), "accumulation": ""}
    accumulation, runs = found.iloc[-1], {}
    for branch, rows in spectrum.sort_values("acceleration").groupby("branch"):
        early = rows[rows.acceleration < accumulation]
        runs[branch] = find_runs(early.acceleration, is_chaotic(early))
    late = spectrum[spectrum.acceleration > accumulation].sort_values("acceleration")
    regular = (late.lambda_1 < -SIGNIFICANT * late.stderr).groupby(late.acceleration).all()
    return {
        "longest_period": str(longest_period),
        "accumulation": f"{accumulation:.2f}",
        "early_up": format_runs(runs["up"], 2) if runs.get("up") else "nowhere",
        "early_down": format_runs(runs["down"], 2) if runs.get("down") else "nowhere",
        "regular_share": f"{100.0 * regular.mean():.0f}",
    }


def overview(
    *, bifurcations: pd.DataFrame, cascade: pd.DataFrame, estimate: pd.DataFrame, map: pd.DataFrame
) -> dict[str, str]:
    folds = bifurcations[(bifurcations.kind == "fold") & bifurcations.proved]
    return {
        "fold": f"{folds.acceleration_low.min():.1f}",
        "accumulation": f"{cascade.accumulation.dropna().iloc[-1]:.2f}",
        "euler_positive": f"{positive_onset(estimate):g}",
        "map_at": f"{map.attrs['model']['acceleration']:g}",
    }


def longest_period(*, longest_period: int) -> dict[str, str]:
    return {"longest_period": str(longest_period)}


def rigid_part(*, rigid: pd.DataFrame, contact: pd.DataFrame) -> dict[str, str]:
    velocities = rigid[rigid.kind == "velocity"]
    compliant, bouncing = (velocities[velocities.model == model] for model in (CONTACT, RIGID))
    leaves = second_from_rest(bouncing)
    both = pd.merge(compliant, bouncing, on=["acceleration", "z0"], suffixes=("_contact", ""))
    later = both[(both.z0 == 0.0) & (both.acceleration >= leaves)]
    arrived = later[(later.mean_velocity > 0.5 * later.mean_velocity_contact) & (later.state_contact != "first")]
    return {
        "duration": f"{contact.attrs['duration']:g}",
        "leaves": f"{second_from_rest(compliant):g}",
        "rigid_leaves": f"{leaves:g}",
        "arrives": f"{lowest(arrived.acceleration):g}",
    }


def scene_budget(*, budget: pd.DataFrame) -> dict[str, str]:
    """Number of tables in which a variant differs visibly from the full model."""
    rows = budget.drop_duplicates(["table", "variant", "tolerance"])
    numbers = {}
    for name, variant in (("rigid", "rigid part"), ("half", "half the time")):
        visible = rows[rows.variant == variant].visible
        numbers |= {f"{name}_seen": str(int(visible.sum())), f"{name}_of": str(len(visible))}
    return numbers


def settling(*, times: pd.DataFrame) -> dict[str, str]:
    settled = times[times.period > 0].cycles
    return {
        "starts": str(times.attrs["starts"]),
        "late": f"{100.0 * (settled > times.attrs['settling']).mean():.1f}",
    }


def scaling(*, scaling: pd.DataFrame) -> dict[str, str]:
    start = scaling.shard_seconds.sub(scaling.computing_seconds).div(scaling.measured)
    return {
        "threads": str(scaling[scaling.varied == "points"].threads.iloc[0]),
        "start": f"{start.median():.1f}",
        "made_whole": f"{scaling.points[(scaling.varied == 'points') & (scaling.measured == scaling.shards)].max():,}",
        "shared_points": f"{scaling[scaling.varied == 'shards'].points.iloc[0]:,}",
        "gathered": f"{scaling.gathered.max():,}",
    }


def speed_accuracy(
    *,
    jumping: pd.DataFrame,
    jumping_times: pd.DataFrame,
    reference: pd.DataFrame,
    paper_step: float,
    equal_error: float,
) -> dict[str, str]:
    runs = speed.successful_runs(jumping, jumping_times)
    paper, *rival = speed.factors(runs, paper_step, equal_error)
    missing = dict.fromkeys(jumping[jumping.outcome == "not installed"].method)
    return {
        "duration": f"{jumping.attrs['duration']:g}",
        "paper_factor": f"{float(f'{paper.ratio:.2g}'):g}",
        "equal_error": format_power(equal_error),
        "rival_factor": f"{float(f'{rival[0].ratio:.2g}'):g}" if rival else "no",
        "rival": rival[0].method if rival else "none of which keeps that error",
        "missing": ", ".join(missing),
        "digits": str(reference.attrs["digits"]),
        "reference_difference": format_power(reference.difference.abs().max()),
        "agreeing": str(int(-np.log10(reference.difference.abs().max()))),
    }


def stability_maps(*, stability: pd.DataFrame) -> dict[str, str]:
    return {
        "start_mm": f"{MM * stability.attrs['conveyor']['z0']:g}",
        "right": f"{100.0 * VELOCITY:g}",
    }


def failed_rivals(*, stability: pd.DataFrame) -> dict[str, str]:
    """Numbers of the stability maps, the hard cases in which other integrators fail, and missing integrators."""
    rivals = stability.attrs["rivals"]["integrators"]
    rows = stability[stability.panel.str.startswith("hard") & stability.method.isin(rivals)]
    failed = rows[~rows.outcome.isin(["right", "not installed"])]
    failures = [
        f"{panel.removeprefix('hard: ')}: {', '.join(methods.method)} ({outcome})"
        for (panel, outcome), methods in failed.groupby(["panel", "outcome"], sort=False)
    ]
    return stability_maps(stability=stability) | {
        "failures": "; ".join(failures) or "none",
        "missing": ", ".join(rows[rows.outcome == "not installed"].method.unique()),
        "tolerance": format_power(stability.attrs["rivals"]["tolerance"]),
        "max_evaluations": f"{stability.attrs['rivals']['max_evaluations']:,}",
    }


def stability_limits(*, stability: pd.DataFrame) -> dict[str, str]:
    own = stability[(stability.method == "event") & stability.panel.isin(PANELS)]
    return stability_maps(stability=stability) | {
        "own_right": str(int((own.outcome == "right").sum())),
        "own_all": str(len(own)),
    }


def sensitivity(*, derivatives: pd.DataFrame, continued: pd.DataFrame, meetings: pd.DataFrame) -> dict[str, str]:
    right = derivatives[derivatives.status == "ok"]
    heights = right[right.kind == "critical_height"].acceleration.unique()
    error = ((right.derivative - right.difference) / right.derivative).abs()[right.elasticity.abs() > SMALL_ELASTICITY]
    own = continued[continued.parameter == "angle"]
    first = continued[continued.kind == "fold"].begin.min()
    cusps = meetings[(meetings.begin == first) & (meetings.meeting == "cusp") & (meetings.parameter == "damping")]
    return {
        "heights": " and ".join(", ".join(f"{one:g}" for one in heights).rsplit(", ", 1)) or "no",
        "error": format_power(error.max()),
        "failed": str(len(derivatives) - len(right)),
        "damping": f"{own.damping_group.iloc[0]:.2f}" if len(own) else "unknown",
        "stiffness": f"{own.stiffness_group.iloc[0]:.1f}" if len(own) else "unknown",
        "exponent": f"{continued.attrs['model']['exponent']:g}",
        "cusp": " and ".join(f"{one:.2f}" for one in cusps[cusps.status == "ok"].damping_group.sort_values()),
    }


def box_numbers(*, shares: pd.DataFrame) -> dict[str, Any]:
    return summarize_shares(shares) | {"largest_error": shares.stderr.max()}


def throw(*, throws: pd.DataFrame, bifurcations: pd.DataFrame) -> dict[str, str]:
    jumps = throws[(throws.state == "second") & (throws.vertical < 1.0)].groupby("conveyor", sort=False).vertical.min()
    most = throws.loc[throws.groupby(["conveyor", "vertical"], sort=False).share.idxmax()]
    most = most[(most.vertical > 1.0) & most.textbook.notna()]
    close = (most.mean_velocity - most.textbook).abs() <= TEXTBOOK_AGREES * most.textbook
    agree = close.groupby(most.conveyor, sort=False).agg(["sum", "count"])
    fold = proved_fold(throws, bifurcations)
    return {
        "starts": str(throws.attrs["starts"]),
        "jumps": ", ".join(f"{throw:.2f} ({name})" for name, throw in jumps.items()),
        "fold": "" if np.isnan(fold) else f"{fold:.3f}",
        "within": f"{100.0 * TEXTBOOK_AGREES:g}",
        "agree": ", ".join(f"{right} of {all_} ({name})" for name, right, all_ in agree.itertuples()),
    }


def track(*, track: pd.DataFrame) -> dict[str, Any]:
    steepest = track[track.mean_velocity > 0.0].groupby("state").inclination.max()
    return {
        "acceleration": f"{track.attrs['acceleration']:g}",
        "limits": [(state, f"{np.degrees(limit):.1f}") for state, limit in steepest.items()],
    }


def identification(
    *, front: pd.DataFrame, profiles: pd.DataFrame, frictions: pd.DataFrame, generations: pd.DataFrame
) -> dict[str, Any]:
    settings = profiles.attrs
    return {
        "settings": settings,
        "coarse": findings.is_coarse(settings),
        "accepted": findings.accepted_frictions(frictions, settings["numbers"]),
        "search": findings.summarize_search(front, generations),
    }


NUMBERS: dict[str, Callable[..., dict[str, Any]]] = {
    "fig03": fig03,
    "fig08": fig08,
    "fig10": fig10,
    "fig11": fig08,
    "fig20": fig20,
    "fig22": fig22,
    "fig23": fig23,
    "fig24": fig24,
    "identification": identification,
    "overview": overview,
    "bifurcation": bifurcation,
    "sensitivity": sensitivity,
    "basin_stability": box_numbers,
    "certificates": longest_period,
    "operating": box_numbers,
    "rigid_part": rigid_part,
    "scene_budget": scene_budget,
    "scaling": scaling,
    "settling": settling,
    "throw": throw,
    "drive": drive_page.summarize_search,
    "track": track,
    "speed_accuracy": speed_accuracy,
    "stability": stability_limits,
    "stability_details": failed_rivals,
}


def caption(template: str, name: str, tables: dict[str, pd.DataFrame], settings: dict, paper: bool = True) -> str:
    """The caption of a figure from its template; `paper` says whether it shows the paper's conveyor.

    Raises
    ------
    jinja2.UndefinedError
        if the template uses a number that the function of the figure in NUMBERS does not return
    """
    numbers = {}
    if function := NUMBERS.get(name):
        available = {**tables, **settings}
        parameters = inspect.signature(function).parameters
        numbers = function(**{name: available[name] for name in parameters if name in available})
    conveyor = "the paper's conveyor" if paper else "this conveyor"
    return render(template, numbers | {"paper": paper, "conveyor": conveyor})


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
