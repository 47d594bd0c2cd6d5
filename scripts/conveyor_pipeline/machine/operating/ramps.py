"""How the amplitude changes when the drive is switched on and off. No slow imports, for captions."""

from collections.abc import Iterable

# How a part gets onto the plate.
AT_REST, DROPPED, FED = KINDS = ("at rest", "dropped", "dropped at full amplitude")
UP, STAY, DOWN = WAYS = ("up", "stay", "down")
SLOWLY = "slow"  # the aim of ramps over all amplitudes; the other ramps lead to the amplitude of an aim of the advice
LOWEST, HIGHEST = 0.5, 1.05  # ends of slow ramps over the largest amplitude of the chart, unless it begins lower
STEP = 1e-3  # relative step of the amplitude in slow ramps, per half cycle
# Why a slow ramp does not show at which amplitude a part changes its motion.
RIDE, JUMP_FIRST = "rides at all amplitudes", "jumps at the lowest amplitude"
CYCLES = 10  # per row of a slow ramp
HOLD = 240  # cycles at the full amplitude; the last third counts
PUSHED = 120  # cycles after a push; the last third counts
COUNTED = 3  # the last part of them, 1/3, counts
REPEATS = 8  # longest period, in cycles, of a motion that repeats itself


def ramp_ends(amplitudes: Iterable[float]) -> tuple[float, float]:
    """Ends of slow ramps (m/s²), which pass all amplitudes of the chart above zero, and some more."""
    highest = max(amplitudes)
    lowest = min([amplitude for amplitude in amplitudes if amplitude > 0.0], default=highest)
    return min(lowest, LOWEST * highest), HIGHEST * highest
