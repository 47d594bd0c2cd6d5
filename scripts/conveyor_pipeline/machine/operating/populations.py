"""Populations of parts, quantiles of their transit and aims of the advice, as texts name them.

No slow imports, for captions.
"""

# The parameters that differ from part to part, in the order of their random numbers.
COLUMNS = ("friction", "damping", "stiffness", "mass", "acceleration")
IDENTICAL, VARIED = POPULATIONS = ("identical", "varied")
PROBABILITIES = (0.05, 0.25, 0.5, 0.75, 0.95)
QUANTILES = tuple(f"velocity_{round(100 * probability):02d}" for probability in PROBABILITIES)
FAST, EVEN = "fast", "even"  # see `advice`
# The quantiles of the slowest and of the fastest parts, %.
ENDS = [round(100 * PROBABILITIES[place]) for place in (0, -1)]


def differences(settings: dict) -> dict[str, dict[str, float] | bool]:
    """How parts differ, from the settings of a transit table.

    `spread` has the relative standard deviations that are not zero, by parameter, and `calibrated` says whether the
    parameters are drawn from the samples of a calibration, too.
    """
    spread = settings["spread"]
    return {
        "spread": {name: share for name, share in spread.items() if name in COLUMNS and share > 0.0},
        "calibrated": spread.get("calibrated", False),
    }
