"""Settings of the stage orbits: orbits, attractors and exponents, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..pipeline.settings import (
    Acceleration,
    Accelerations,
    Duration,
    Followed,
    Height,
    Model,
    Name,
    Tolerance,
    Velocity,
    interval,
    many,
    number,
    whole,
    word,
)
from ..pipeline.table_settings import FOLLOWED, model_of, with_model

Epsilon = number("size of the perturbation, in units of the perturbed parameter", ge=1e-15, le=1)


class Estimate(Followed):
    duration: NotRequired[Duration]
    perturb: word("perturbed parameter", "psi0", "z0", "vz0")
    epsilon: Epsilon
    output: word("compared state variable", "x", "vx", "z", "vz")
    last: number("share of the run that is averaged", "of the duration", gt=0, lt=1)


class SeedOrbit(TypedDict):
    acceleration: Acceleration
    z0: Height
    vz0: NotRequired[Velocity]


class Orbits(TypedDict):
    seeds: NotRequired[
        Annotated[
            list[SeedOrbit], Field(min_length=1, max_length=1000, description="initial conditions of the first orbits")
        ]
    ]
    limits: interval(Acceleration, "amplitudes between which branches are followed")
    max_period: whole("longest period that is followed", 1, 64, "excitation cycles")
    model: NotRequired[Model]


class CertifiedChaos(TypedDict):
    acceleration: many(Acceleration, "amplitudes of the proofs of chaos", least=0)


class Certificates(TypedDict):
    acceleration: Accelerations
    doubled_limit: Acceleration
    doublings: whole("period doublings that are proved", 0, 8)
    chaos: Annotated[CertifiedChaos, Field(description="proofs of chaos")]


class Attractors(TypedDict):
    acceleration: Accelerations
    transient: whole("excitation cycles before recording", 0, 10**9, "excitation cycles")
    strobes: whole("stroboscopic samples, one per excitation cycle", 1, 10**9)
    model: NotRequired[Model]
    tolerance: NotRequired[Tolerance]


SECTIONS = {
    "estimates": Annotated[
        dict[Name, Estimate], Field(description="Lyapunov exponents by finite differences (Eq. 23)")
    ],
    "orbits": Annotated[Orbits, Field(description="periodic orbits of the vertical motion")],
    "certificates": Annotated[Certificates, Field(description="proofs of orbits, bifurcations and chaos")],
    "attractors": Annotated[Attractors, Field(description="stroboscopic states over the amplitude")],
}


# Further amplitudes of proofs on the paper's conveyor (m/s²): 50 to 59 for Fig. 22, then stable orbits of 4, 8 and 16
# cycles.
ALSO = (51.0, 52.0, 53.0, 54.0, 56.0, 57.0, 58.0, 59.0, 62.0, 62.6, 62.73)
SPECTRUM_TOLERANCE = 1e-12  # of Lyapunov exponents: λ1 + λ2 is checked to 1e-8


def spectrum_settings(config: dict) -> dict:
    return with_model(config, "attractors", solver=FOLLOWED, normal=True) | {"tolerance": SPECTRUM_TOLERANCE}


def certificates_settings(config: dict) -> dict:
    own = config["certificates"]
    axis = own["acceleration"]
    ends = axis if isinstance(axis, list) else (axis["start"], axis["stop"])
    also = [acceleration for acceleration in ALSO if min(ends) <= acceleration <= max(ends)]
    return {**own, "also": also, "model": model_of(config, "orbits", normal=True)}


# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {
    **dict.fromkeys(
        ("orbits/branches", "orbits/folds_and_doublings", "orbits/cascade"),
        lambda config: with_model(config, "orbits", solver=("tolerance",), normal=True),
    ),
    **dict.fromkeys(
        (
            *("orbits/certificates", "orbits/certified_bifurcations", "orbits/certified_chaos"),
            "orbits/certificate_times",
        ),
        certificates_settings,
    ),
    "attractors/strobes": lambda config: with_model(config, "attractors", solver=FOLLOWED, normal=True),
    "lyapunov/spectrum": spectrum_settings,
    "lyapunov/witnesses": lambda config: with_model(config, "attractors", solver=FOLLOWED, normal=True),
}
