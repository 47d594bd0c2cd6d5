"""The range of the amplitude of a drive without a controller, from its supply. No slow imports.

The drive is an oscillator with the resonance f₀ and the damping ratio ζ, which a force of the excitation frequency f
drives. Its acceleration has the amplitude (Den Hartog 1956, Mechanical Vibrations, ch. 2)

    â ~ F f²/√((f₀² - f²)² + (2 ζ f₀ f)²).

At a fixed frequency, the force F of an electromagnet grows with the square of the voltage; the model neglects that this
force falls as the frequency rises. The force of a voice coil or a piezo actuator grows with the voltage, and that of
unbalanced masses with the square of the frequency. The parts do not act back on the drive.
"""

import math

# Powers of the voltage and of the frequency in the force.
FORCES = {"voltage²": (2, 0), "voltage": (1, 0), "frequency²": (0, 2)}
# Largest ratio of resonance and excitation, either way. Beyond it, the displacement is at most an eighth larger than
# under a constant force of this size, or at most an eighth of it: a drive is tuned to a nearer resonance.
FARTHEST = 3.0
POINTS = 400  # intervals in which the range of the frequency is searched
DIGITS = 6  # of the range


def amplitude(frequency: float, supply: dict) -> float:
    """Amplitude of the acceleration at a frequency (Hz), up to a factor."""
    resonance, ratio = supply["resonance"], supply["damping_ratio"]
    stiff, damped = resonance**2 - frequency**2, 2.0 * ratio * resonance * frequency
    _, power = FORCES[supply["force"]]
    return frequency ** (2 + power) / math.hypot(stiff, damped)


def amplitude_range(supply: dict, frequency: float) -> tuple[float, float]:
    """Lowest and highest amplitude over the one at the stated frequency (Hz) and voltage.

    Examples
    --------
    >>> supply = {"voltage": 0.05, "frequency": 0.0, "resonance": 52.0, "damping_ratio": 0.02, "force": "voltage²"}
    >>> amplitude_range(supply, 50.0)
    (0.9025, 1.1025)
    """
    shift, resonance = supply["frequency"], supply["resonance"]
    frequencies = [frequency + shift * (2.0 * k / POINTS - 1.0) for k in range(POINTS + 1)]
    # Near the resonance lies the largest amplitude.
    frequencies += [resonance] if abs(resonance - frequency) < shift else []
    amplitudes = [amplitude(value, supply) / amplitude(frequency, supply) for value in frequencies]
    power, _ = FORCES[supply["force"]]
    low, high = (1.0 - supply["voltage"]) ** power, (1.0 + supply["voltage"]) ** power
    return tuple(float(f"{end:.{DIGITS}g}") for end in (low * min(amplitudes), high * max(amplitudes)))
