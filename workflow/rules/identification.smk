# Which parameters the paper's numbers imply: what the claims measure, over the parameters, and what fits the numbers best.


def accepted(number):
    """The paper's number CLAIM.QUANTITY and the interval that is accepted for it."""
    claim, quantity = number.split(".")
    one = config["claims"][claim]["quantities"][quantity]
    return {"is": one["is"], "paper": one["paper"], "low": one["accepted"][0], "high": one["accepted"][1]}


def ends_of(axis):
    """First and last value of an axis, and how many there are."""
    values = [axis["start"], axis["stop"]] if isinstance(axis, dict) else [axis[0], axis[-1]]
    return [*values, count_values(axis)]


def measured():
    """What of the config the claims measure the numbers with, for identification.measures."""
    sweeps, fit = config["sweeps"], config["regressions"]["height"]
    return {
        "inside": config["identification"]["inside"],
        "interval": fit["acceleration"],
        "starts": ends_of(sweeps["amplitudes"]["axes"]["z0"]),
        "moved_starts": ends_of(sweeps["interval"]["axes"]["z0"]),
        "critical": {name: config["claims"][name]["settings"]["acceleration"] for name in ("C07", "C08")},
        "triple": fit["paper"],
        "bounds_of_b": fit["bounds"]["B"],
    }


def needed(*names):
    """A param: parts of the section `identification`, and what of the rest of the config a rule needs.

    It is put together when a rule runs: a config without the paper's claims identifies nothing.
    """

    def settings_of(wildcards):
        own = config["identification"]
        searched = [number for group in own["objectives"].values() for number in group]
        numbers = [*searched, "C09.A", "C09.B", "C09.C"]
        rest = {
            "numbers": lambda: {number: accepted(number) for number in numbers},
            "measured": measured,
            "euler": lambda: {
                **{name: config["solver"][name] for name in ("duration", "step", "settling")},
                "method": "euler",
            },
        }
        found = {name: rest[name]() if name in rest else own[name] for name in names}
        return {**found, "model": MODEL_OF_ANY_AMPLITUDE}

    return settings_of


EDGES = ("bounds", "contacts", "heights", "edges")
SEARCH = ("bounds", "objectives", "search", "numbers", "measured")


def identification_rule(stage, message, outputs, inputs, names, **rest):
    RULES[f"identification_{stage}"] = {
        "stage": f"identification.{stage}",
        "message": message,
        "input": tables_of("identification", *inputs),
        "output": tables_of("identification", *outputs),
        "place": f"identification/{stage}",
        "params": {"settings": needed(*dict.fromkeys(names))},
        "priority": 2,
        **rest,
    }


identification_rule("edges", "Edges of the first state over the contact", ["edges"], [], EDGES, threads=THREADS)
identification_rule(
    "printed",
    "The paper's numbers at its parameters",
    ["printed"],
    ["edges"],
    ("heights", "edges", "told", "numbers", "measured", "euler"),
)
identification_rule(
    "fronts",
    "What fits the paper's numbers best",
    ["front", "generations"],
    ["edges"],
    (*SEARCH, "readings"),
)
identification_rule(
    "profiles",
    "What the paper's numbers say of each parameter",
    ["profiles", "optima", "frictions", "implied"],
    ["edges", "front", "printed"],
    (*SEARCH, *EDGES, "evidence", "profiles"),
)
