"""Settings of the stage orbits: orbits, attractors and exponents, with units and ranges."""

from typing import NotRequired

from typing_extensions import TypedDict

from conveyor_pipeline.common.axes import ends
from conveyor_pipeline.common.settings import (
    Acceleration,
    Accelerations,
    Followed,
    Height,
    Model,
    Tolerance,
    Velocity,
    described,
    entries,
    interval,
    list_of,
    number,
    whole,
    word,
)
from conveyor_pipeline.common.table_settings import model_of

Epsilon = number("size of the perturbation, in units of the perturbed parameter", ge=1e-15, le=1)


class Estimate(Followed):
    perturb: word("perturbed parameter", "psi0", "z0", "vz0")
    epsilon: Epsilon
    output: word("compared state variable", "x", "vx", "z", "vz")
    last: number("share of the run that is averaged", "of the duration", gt=0, lt=1)


class SeedOrbit(TypedDict):
    acceleration: Acceleration
    z0: Height
    vz0: NotRequired[Velocity]


class Orbits(TypedDict):
    seeds: described(
        list[SeedOrbit], "initial conditions of the first orbits; empty: all amplitudes are searched", max_length=1000
    )
    limits: interval(Acceleration, "amplitudes between which branches are followed")
    max_period: whole("longest period that is followed", 1, 64, "excitation cycles")
    model: NotRequired[Model]


class CertifiedChaos(TypedDict):
    acceleration: list_of(Acceleration, "amplitudes of the proofs of chaos", min_length=0)


class Certificates(TypedDict):
    acceleration: Accelerations
    doubled_limit: Acceleration
    doublings: whole("period doublings that are proved", 0, 8)
    chaos: described(CertifiedChaos, "proofs of chaos")


class Attractors(TypedDict):
    acceleration: Accelerations
    transient: whole("excitation cycles before recording", 0, 10**9, "excitation cycles")
    strobes: whole("stroboscopic samples, one per excitation cycle", 1, 10**9)
    model: NotRequired[Model]
    tolerance: NotRequired[Tolerance]


SECTIONS = {
    "estimates": entries(Estimate, "Lyapunov exponents by finite differences (Eq. 23)"),
    "orbits": described(Orbits, "periodic orbits of the vertical motion"),
    "certificates": described(Certificates, "proofs of orbits, bifurcations and chaos"),
    "attractors": described(Attractors, "stroboscopic states over the amplitude"),
}
# Further amplitudes of proofs on the paper's conveyor (m/s²): 50 to 59 for Fig. 22, then stable orbits of 4, 8 and 16
# cycles.
ALSO = (51.0, 52.0, 53.0, 54.0, 56.0, 57.0, 58.0, 59.0, 62.0, 62.6, 62.73)
CERTIFIED_TABLES = ("certificates", "certified_bifurcations", "certified_chaos", "certificate_times")
SPECTRUM_TOLERANCE = 1e-12  # of Lyapunov exponents: λ1 + λ2 is checked to 1e-8


def with_solver(config: dict, section: str, *keys: str) -> dict:
    """A section with some keys of the section `solver`, which it may replace, and with its model."""
    settings = {key: config["solver"][key] for key in keys} | config[section]
    return settings | {"model": model_of(config, section, normal=True)}


def branches_settings(config: dict) -> dict:
    return with_solver(config, "orbits", "tolerance")


def certified_settings(config: dict) -> dict:
    section = config["certificates"]
    low, high = (end(ends(section["acceleration"])) for end in (min, max))
    also = [acceleration for acceleration in ALSO if low <= acceleration <= high]
    return {**section, "also": also, "model": model_of(config, "orbits", normal=True)}


def strobes_settings(config: dict) -> dict:
    return with_solver(config, "attractors", "tolerance", "settling")


def exponents_settings(config: dict) -> dict:
    return strobes_settings(config) | {"tolerance": SPECTRUM_TOLERANCE}


TABLE_SETTINGS = {
    **dict.fromkeys(("orbits/branches", "orbits/folds_and_doublings", "orbits/cascade"), branches_settings),
    **dict.fromkeys((f"orbits/{name}" for name in CERTIFIED_TABLES), certified_settings),
    "attractors/strobes": strobes_settings,
    "lyapunov/spectrum": exponents_settings,
    **dict.fromkeys(
        ("results/stability_estimates", "results/moved_impacts"), lambda config: {"model": model_of(config)}
    ),
}
