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


def identification(wildcards):
    """A param: the section `identification`, and all of the config that its numbers are measured with."""
    own, sweeps = config["identification"], config["sweeps"]
    fit = config["regressions"]["height"]
    numbers = [*(one for group in own["objectives"].values() for one in group), "C09.A", "C09.B", "C09.C"]
    return {
        **own,
        "model": MODEL_OF_ANY_AMPLITUDE,
        "numbers": {number: accepted(number) for number in numbers},
        "measured": {
            "inside": own["inside"],
            "interval": fit["acceleration"],
            "starts": ends_of(sweeps["amplitudes"]["axes"]["z0"]),
            "moved_starts": ends_of(sweeps["interval"]["axes"]["z0"]),
            "critical": {name: config["claims"][name]["settings"]["acceleration"] for name in ("C07", "C08")},
            "triple": fit["paper"],
            "bounds_of_b": fit["bounds"]["B"],
        },
        "euler": {**{name: config["solver"][name] for name in ("duration", "step", "settling")}, "method": "euler"},
    }


def identification_rule(name, stage, message, outputs, inputs=(), **rest):
    RULES[name] = {
        "stage": f"identification.{stage}",
        "message": message,
        "input": tables_of("identification", *inputs),
        "output": tables_of("identification", *outputs),
        "place": f"identification/{stage}",
        "params": {"settings": identification},
        **rest,
    }


identification_rule("edges", "edges", "Edges of the first state over the contact", ["edges"], threads=2)
identification_rule("printed", "printed", "The paper's numbers at its parameters", ["printed"], ["edges"], threads=2)
identification_rule("fronts", "fronts", "What fits the paper's numbers best", ["front", "generations"], ["edges"])
identification_rule(
    "profiles",
    "profiles",
    "What the paper's numbers say of each parameter",
    ["profiles", "optima", "frictions", "implied"],
    ["edges", "front", "printed"],
)
