"""Parts of the config that the tables of the identification need; imported by the Snakefile: no slow imports."""

# Quantities of claims that scripts/identification/measures.py computes for any conveyor.
NUMBERS_OF_CLAIMS = (
    "C01.critical_amplitude",
    "C02.lower_end",
    "C02.upper_end",
    "C04.largest_height",
    "C05.velocity_at_lower_end",
    "C05.velocity_at_upper_end",
    "C06.fall",
    "C07.height",
    "C08.height",
    "C09.error",
    "C10.lower_end",
    "C10.upper_end",
)
# The parts of the section `identification`, and of the rest of the config, that each of its tables needs.
EDGES = ("bounds", "contacts", "heights", "edges")
SEARCH = ("bounds", "objectives", "search", "numbers", "measured")
IDENTIFICATION = {
    "edges": EDGES,
    "printed": ("heights", "edges", "reported", "numbers", "measured", "euler"),
    **dict.fromkeys(("front", "generations"), (*SEARCH, "readings")),
    **dict.fromkeys(("profiles", "optima", "frictions", "implied"), (*SEARCH, *EDGES, "evidence", "profiles")),
}


def identification_settings(config: dict, table: str, model: dict) -> dict:
    """The parts of a config that a table of the section `identification` needs, with the model."""
    own = config["identification"]
    computed = {"numbers": paper_numbers, "measured": measured_quantities, "euler": published_method}
    parts = IDENTIFICATION[table]
    settings = {name: computed[name](config) if name in computed else own[name] for name in parts}
    return {**settings, "model": model}


def paper_numbers(config: dict) -> dict[str, dict]:
    """The paper's numbers CLAIM.QUANTITY that the search fits, each with the accepted interval."""
    own = config["identification"]
    searched = [number for group in own["objectives"].values() for number in group]
    found = {}
    for number in [*searched, "C09.A", "C09.B", "C09.C"]:
        claim, name = number.split(".")
        quantity = config["claims"][claim]["quantities"][name]
        low, high = quantity["accepted"]
        found[number] = {"is": quantity["is"], "paper": quantity["paper"], "low": low, "high": high}
    return found


def measured_quantities(config: dict) -> dict:
    """The axes and settings with which the claims measure these numbers."""

    def ends_and_count(axis: list | dict) -> list:
        if isinstance(axis, dict):
            return [axis["start"], axis["stop"], axis["num"]]
        return [axis[0], axis[-1], len(axis)]

    sweeps, fit = config["sweeps"], config["regressions"]["height"]
    return {
        "inside": config["identification"]["inside"],
        "interval": fit["acceleration"],
        "starts": ends_and_count(sweeps["amplitudes"]["axes"]["z0"]),
        "moved_starts": ends_and_count(sweeps["interval"]["axes"]["z0"]),
        "critical": {name: config["claims"][name]["settings"]["acceleration"] for name in ("C07", "C08")},
        "triple": fit["paper"],
        "bounds_of_b": fit["bounds"]["B"],
    }


def published_method(config: dict) -> dict:
    """The settings of the paper's method, explicit Euler."""
    return {**{name: config["solver"][name] for name in ("duration", "step", "settling")}, "method": "euler"}
