"""Numbers of samples of the calibration, which `calibration.effort` multiplies."""

# Of the search, by an effort of 1.
FIRST = 256  # sets of parameters of the first round of the first step, which fills the ranges
POINTS = 64  # of each further round
ROUGH_ROUNDS, ROUNDS = 28, 16  # further rounds of the two steps of a search; it goes on for up to as many if needed
ENOUGH = 100.0  # effective number of samples at which a search ends; the ends of an interval move little with more
SEARCHES, MOST_SEARCHES = 3, 5  # independent ones, at first and at most
# Effective number of samples from which a search has converged: one of the posterior, and one of an evidence.
EFFECTIVE, EFFECTIVE_OF_EVIDENCE = 40.0, 10.0
# Of what follows from the posterior. A trial has fewer; with more, no number would change that a reader sees.
ROUGH_PARTS, PARTS = 8, 12  # random initial conditions for each set and each amplitude in the two steps of a search
SAMPLES = 256  # of the posterior in the table
CHECKED = 8  # of these samples are tested against the measurements
CHECKED_PARTS = 64  # random initial conditions for the density of this test, and as many for the replicates
REPLICATES = 2000  # of all measurements, for each of the tested samples: p-values of 0.01 are known to ± 0.002
AMPLITUDES = 49  # between the lowest and the highest measured one, at which velocities are predicted
PREDICTED = 64  # samples from which velocities are predicted
PREDICTED_PARTS = 8  # random initial conditions for each of them


def sizes_of(effort: float) -> dict[str, float]:
    """All numbers of samples for an effort, each at least as large as its use demands."""
    capped = min(effort, 1.0)
    return {
        "first": max(32, round(effort * FIRST)),
        "points": max(32, round(effort * POINTS)),
        "rough_rounds": max(1, round(effort * ROUGH_ROUNDS)),
        "rounds": max(1, round(effort * ROUNDS)),
        "enough": max(EFFECTIVE, effort * ENOUGH),
        "parts": max(8, round(capped * PARTS)),
        "rough_parts": ROUGH_PARTS,
        "samples": max(32, round(capped * SAMPLES)),
        "checked": max(2, round(capped * CHECKED)),
        "checked_parts": max(8, round(capped * CHECKED_PARTS)),
        "replicates": max(200, round(capped * REPLICATES)),
        "amplitudes": max(5, round(capped * AMPLITUDES)),
        "predicted": max(16, round(capped * PREDICTED)),
        "predicted_parts": PREDICTED_PARTS,
    }
