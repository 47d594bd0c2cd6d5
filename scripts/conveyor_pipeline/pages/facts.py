"""Facts for the pages: README, article, site and metadata take their numbers from the file that this stage makes.

It has the facts of `collect_facts`, and these:

    version           of the library and the workflow
    prefix            prefix of the config; empty for the paper's config
    step              time step of the paper's method, s
    tighter           factor between the usual tolerances and the tighter ones that give the uncertainty of the claims
    figures           titles and sections of all figures, by name
    statements        the claims as described by claims.verdicts, by name
    costs             of the jobs of the build by kind, and of `everything`, as common.provenance describes
"""

import json
from typing import Any

import numpy as np
import pandas as pd

from conveyor.analysis.stroboscopic_map import MAX_PERIOD
from conveyor_pipeline.machine.excitation import effects
from conveyor_pipeline.machine.operating.populations import ENDS, EVEN, POPULATIONS, differences
from conveyor_pipeline.machine.operating.regimes import SEVERAL
from conveyor_pipeline.pages.flat_blocks import compare_flat
from conveyor_pipeline.paper.caption_numbers import fig10, moved_impacts
from conveyor_pipeline.paper.caption_numbers.bifurcation import accumulation
from conveyor_pipeline.paper.claims.about_proofs import lowest_fold, stable_motions
from conveyor_pipeline.paper.claims.about_states import flat_part
from conveyor_pipeline.paper.claims.verdicts import VERDICTS, describe_claims
from conveyor_pipeline.study.accuracy.scenes import SCENES
from conveyor_pipeline.study.accuracy.speed import at_default


def margin(value: float, low: float, high: float) -> float:
    """Distance of a number from the nearest end of its accepted interval; negative outside, NaN for NaN."""
    return float(np.nanmin([value - low, high - value])) if not np.isnan(value) else np.nan


def describe_interval(low: float, high: float) -> str:
    """An accepted interval in words; NaN is no bound."""
    if np.isnan(low):
        return f"at most {high:.8g}"
    return f"at least {low:.8g}" if np.isnan(high) else f"{low:.8g} to {high:.8g}"


def names_by_verdict(claims: pd.DataFrame) -> dict[str, list[str]]:
    """The names of the claims with each verdict."""
    names = ("reproduced", "by_paper", "not_reproduced")
    return {name: claims.id[claims.verdict == verdict].tolist() for name, verdict in zip(names, VERDICTS, strict=True)}


def late_limits(claims: pd.DataFrame) -> list[str]:
    """The names of the claims with a limit that was set when the numbers were known."""
    return claims.id[
        claims.because.map(lambda reasons: any("when the numbers were known" in reason for reason in reasons))
    ].tolist()


def summarize_proofs(orbits: pd.DataFrame, bifurcations: pd.DataFrame, chaos: pd.DataFrame) -> dict[str, Any]:
    """Numbers of proved orbits and bifurcations, and where two stable motions and chaos are proved."""
    counts = stable_motions(orbits)
    return {
        "fold": lowest_fold(bifurcations),
        "orbits_tried": len(orbits),
        "orbits_proved": orbits.contained.sum(),
        "doublings_proved": ((bifurcations.kind == "period_doubling") & bifurcations.proved).sum(),
        "both_stable": counts.index[counts >= 2],
        "chaos_proved": chaos.acceleration[chaos.proved],
    }


def summarize_speed(tables: dict[str, pd.DataFrame]) -> dict[str, Any]:
    """Speed and accuracy of the solver at its default tolerance, in all scenes of the tables of precision."""
    default = pd.DataFrame([at_default(scene, tables[scene], tables[f"{scene}_times"]) for scene in SCENES])
    return {
        "speeds": default.speed_without,
        "reuse_speeds": default.speed,
        "tolerance": default.tolerance.iloc[0],
        "worst_error": default.error.max(),
    }


def evenest_from(varied: pd.DataFrame, onset: float | None) -> float | None:
    """The lowest amplitude (m/s²) from which on parts travel more evenly than at all below the onset of chaos.

    None if there is no such amplitude, or if the onset is not known.
    """
    if onset is None:
        return None
    spread = varied.sort_values("acceleration").set_index("acceleration").spread
    later = spread[::-1].cummax()[::-1]
    even = later.index[(later < spread[spread.index < onset].min()) & (later.index >= onset)]
    return float(even.min()) if len(even) else None


def summarize_transit(
    transit: pd.DataFrame, lengths: pd.DataFrame, advice: pd.DataFrame, onset: float | None
) -> dict[str, Any]:
    """Where identical parts differ most in their velocity, the advised even amplitude, and the track's length."""
    widest = lengths[lengths.regime == SEVERAL].sort_values(["spread", "length"]).acceleration.iloc[-1]
    identical, varied = (transit[transit.population == kind] for kind in POPULATIONS)
    return {
        "uneven": identical.loc[(identical.acceleration - widest).abs().idxmin()].to_dict(),
        "even": advice.set_index("aim").loc[EVEN].to_dict(),
        "evenest_from": evenest_from(varied, onset),
        "track": transit.attrs["length"],
        "middle": ENDS[1] - ENDS[0],
        "differences": differences(transit.attrs)["spread"],
    }


def collect_facts(tables: dict[str, pd.DataFrame]) -> dict[str, Any]:
    """All facts of the pages, by the names that templates use.

    Parameters
    ----------
    tables : claims, errors and times of the scenes by the names SCENE and SCENE_times, edge, edge_euler, estimate,
        estimate_euler, on_plate, spectrum, cascade, certificates, certified_bifurcations, certified_chaos, fit,
        moved, transit, lengths, advice, drives and bodies
    """
    claims = tables["claims"].set_index("id")
    first_error, second_error, equal_signs = claims.paper_method["C22"]
    onset = accumulation(spectrum=tables["spectrum"], cascade=tables["cascade"])
    return {
        "euler_positive": claims.paper_method["C19"][0],
        "converged_positive": claims.converged["C19"][0],
        "lowest_chaos": tables["on_plate"].acceleration[tables["on_plate"].state == "chaos"].min(),
        "scatter": claims.converged["C03"][0],
        "first_error": first_error,
        "second_error": second_error,
        "equal_signs": equal_signs,
        "moved": moved_impacts.numbers(moved=tables["moved"]),
        "paper_two_states": claims.paper["C02"],
        "heights_aside": fig10.numbers(converged=tables["edge"], fit=tables["fit"], euler=tables["edge_euler"])[
            "aside"
        ],
        "longest_period": MAX_PERIOD,
        "epsilon": tables["estimate"].attrs["epsilon"],
        "valley": flat_part(tables["fit"]).B,
        **onset,
        **names_by_verdict(tables["claims"]),
        "late_limits": late_limits(tables["claims"]),
        **summarize_proofs(tables["certificates"], tables["certified_bifurcations"], tables["certified_chaos"]),
        **summarize_speed(tables),
        **summarize_transit(tables["transit"], tables["lengths"], tables["advice"], onset["accumulation"]),
        "clean": effects.statement_of(tables["drives"]),
        "flat": compare_flat(tables["bodies"]),
    }


def make(provenance: str, values: dict[str, Any], **tables: pd.DataFrame) -> str:
    """The facts as JSON.

    Parameters
    ----------
    provenance : of the build, as JSON
    values : version, prefix, step, tighter and figures, as above
    tables : as `collect_facts` needs them
    """
    facts = {
        **values,
        **collect_facts(tables),
        "statements": {claim["id"]: claim for claim in describe_claims(tables["claims"])},
        "costs": json.loads(provenance)["costs"],
    }
    return json.dumps(facts, indent=1, ensure_ascii=False, default=lambda numbers: numbers.tolist()) + "\n"
