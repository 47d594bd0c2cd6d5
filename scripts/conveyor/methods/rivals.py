"""The integrators that the solver is compared with: their packages, methods and options."""

from importlib import metadata
from typing import NamedTuple


class Rival(NamedTuple):
    distribution: str  # the package's name on PyPI
    module: str
    method: str  # in the package's own words
    options: str


COMMON = (
    "right-hand side compiled by numba; absolute tolerance: the relative one times the plate's motion; "
    "a restart at each event"
)
SCIPY = f"solve_ivp, terminal and directional events; {COMMON}"
CYRK = f"pysolve_ivp, pass_dy_as_arg, terminal and directional events; {COMMON}"
CVODE = f"root finding with directions, a kept solver for each mode, stop time at the end; {COMMON}"
TAYLOR = "a compiled Taylor integrator for each mode, terminal and directional events, a restart at each event"

RIVALS = {
    **{name: Rival("scipy", "scipy", name, SCIPY) for name in ("RK45", "DOP853", "Radau", "LSODA")},
    **{f"CyRK {name}": Rival("CyRK", "CyRK", name, CYRK) for name in ("DOP853", "Vern8")},
    **{f"CVODE {name}": Rival("scikit-sundae", "sksundae", name, CVODE) for name in ("Adams", "BDF")},
    "heyoka": Rival("heyoka", "heyoka", "Taylor", TAYLOR),
}


def installed_version(integrator: str) -> str | None:
    """Version of the package of an integrator; None where it is not installed."""
    try:
        return metadata.version(RIVALS[integrator].distribution)
    except metadata.PackageNotFoundError:
        return None


def record_rivals() -> dict[str, dict[str, str]]:
    """Version and options of every integrator, for the provenance.

    Examples
    --------
    >>> record_rivals()["heyoka"]["options"].split(":")[0]
    'Taylor'
    """
    return {
        name: {"version": installed_version(name) or "not installed", "options": f"{rival.method}: {rival.options}"}
        for name, rival in RIVALS.items()
    }
