"""The plate: no other module of the solver knows how it moves.

With θ = ωt + ψ0 and the orders k of the harmonics, the accelerations of the plate normal to the track and along it are

    z̈_s = a_z [cos θ + Σ normal_k cos(kθ + normal_phase_k)],
    ẍ_s = a_x [cos(θ + ε) + Σ along_k cos(kθ + along_phase_k)].

Velocities and positions are the integrals without a mean. Functions of a phase take its sine and cosine, from which
those of kθ follow by the angle addition theorem. `c` is contact.Constants.

Whether a plate has harmonics is a type: `c.waves` is None for the paper's plate, for which Numba compiles the
fundamental alone. The code of harmonics is compiled when a plate with harmonics is met. A function whose code differs
takes `waves` as an argument of its own, because Numba drops code only where an argument is None.
"""

import math
from collections import namedtuple
from collections.abc import Callable, Sequence

import numpy as np

from ..parameters import PARAMETERS
from .jit import compiled, compiled_inline, compiled_into_callers, copy, number_at
from .polynomial import ORDER, SIZE, place
from .unrolled import product, total
from .workspace import ALONG, COSINE, HARMONICS, LIFT_W, NORMAL, SINE, WAVE, T, V, W

# A harmonic in packed parameters: its order k and, as shares of the fundamental's amplitudes, the coefficients of
# cos kθ and -sin kθ in the accelerations along the track and normal to it.
K, ALONG_COSINE, ALONG_SINE, NORMAL_COSINE, NORMAL_SINE = range(5)
NUMBERS = 5

# The search for the largest value over a cycle: phases of a scan, then scans of the neighbourhood of the largest value
# and the phases of each.
PHASES, FINER, CLOSE = 4096, 3, 64

# The harmonics of a conveyor: their number, and the address of their numbers in the parameter vector. It must exist as
# long as they are in use.
Waves = namedtuple("Waves", "count address")
# What harmonics add to position, velocity and acceleration normal to the track (z, vz, az) and along it (x, vx, ax), as
# shares of the fundamental's amplitudes; the position with the opposite sign.
Sums = namedtuple("Sums", "z vz az x vx ax")
# The first row of harmonics in a workspace, and its number of lanes.
WAVES, ONE = np.uint64(HARMONICS), np.uint64(1)
# A negative zero changes no number that it is added to, not even a zero, so that the compiler drops the sum.
NO_SUMS = Sums(-0.0, -0.0, -0.0, -0.0, -0.0, -0.0)
# Position and velocity normal to the track, velocity and acceleration along it, divided by their amplitudes.
Shapes = namedtuple("Shapes", "z vz vx ax")
# Bounds: on position (m), acceleration (m/s²) and its rate (m/s³) normal to the track; on acceleration and its rate
# along the track, as multiples of a_x and a_x ω.
Bounds = namedtuple("Bounds", "height lift jerk pull pull_rate")
# The largest sizes of positions, velocity and accelerations along the track (x, vx, ax) and normal to it (z, az), as
# multiples of the fundamental's amplitudes.
Peaks = namedtuple("Peaks", "x z vx ax az")
# What functions of a phase take of contact.Constants, for other callers; other arithmetic has no harmonics.
Plate = namedtuple("Plate", "omega a_x a_z cos_shift sin_shift waves")


def count_harmonics(parameters: np.ndarray) -> int | None:
    """The number of harmonics in packed parameters, shape (…, 16 + 5 h), or None for a plate without."""
    return (parameters.shape[-1] - len(PARAMETERS)) // NUMBERS or None


@compiled_inline
def waves_of(parameters, harmonics):
    """The Waves of a packed parameter vector with a number of harmonics; None if that is None."""
    if harmonics is None:
        return None
    return Waves(harmonics, parameters[len(PARAMETERS) :].ctypes.data)


@compiled_inline
def sine_and_cosine(phase):
    """Sine and cosine of a phase (rad), which the functions of a phase take."""
    return math.sin(phase), math.cos(phase)


@compiled_inline
def add_phases(sine, cosine, s, c):
    """Sine and cosine of the sum of two phases."""
    return sine * c + cosine * s, cosine * c - sine * s


@compiled_inline
def multiple(order, sine, cosine):
    """Sine and cosine of a multiple of a phase."""
    s, c = sine, cosine
    for _ in range(order - 1):
        s, c = add_phases(s, c, sine, cosine)
    return s, c


@compiled_inline
def numbers_of(waves, h):
    """The numbers of harmonic h of Waves, in the order above."""
    first = h * NUMBERS
    return (
        number_at(waves.address, first + K),
        number_at(waves.address, first + ALONG_COSINE),
        number_at(waves.address, first + ALONG_SINE),
        number_at(waves.address, first + NORMAL_COSINE),
        number_at(waves.address, first + NORMAL_SINE),
    )


@compiled_inline
def numbers_at(series, row, lanes):
    """The numbers of a harmonic, in the order above, from their first row on; row and lanes are unsigned."""
    return (
        series[row],
        series[row + lanes],
        series[row + lanes + lanes],
        series[row + lanes + lanes + lanes],
        series[row + lanes + lanes + lanes + lanes],
    )


@compiled_inline
def add_harmonic(sums, harmonic, s, c):
    """The Sums with one more harmonic, given by its numbers; s and c are sine and cosine of kθ."""
    z, vz, az, x, vx, ax = sums
    k, along_cosine, along_sine, normal_cosine, normal_sine = harmonic
    share = 1.0 / k  # one division in place of four
    wave, slope = normal_cosine * c - normal_sine * s, normal_cosine * s + normal_sine * c
    z, vz, az = z + wave * share * share, vz + slope * share, az + wave
    wave, slope = along_cosine * c - along_sine * s, along_cosine * s + along_sine * c
    return Sums(z, vz, az, x + wave * share * share, vx + slope * share, ax + wave)


@compiled_inline
def sums_of(waves, sine, cosine):
    """The Sums of Waves, or of None, at the phase with a sine and cosine."""
    sums = NO_SUMS
    if waves is not None:
        for h in range(waves.count):
            harmonic = numbers_of(waves, h)
            sums = add_harmonic(sums, harmonic, *multiple(int(harmonic[K]), sine, cosine))
    return sums


@compiled_inline
def bounds(waves, a_z, omega):
    """The Bounds of the motion of a plate with Waves, or None."""
    z = normal = jerk = along = rate = 1.0
    if waves is not None:
        for h in range(waves.count):
            k, along_cosine, along_sine, normal_cosine, normal_sine = numbers_of(waves, h)
            share = math.hypot(normal_cosine, normal_sine)
            z, normal, jerk = z + share / (k * k), normal + share, jerk + k * share
            share = math.hypot(along_cosine, along_sine)
            along, rate = along + share, rate + k * share
    return Bounds(a_z / (omega * omega) * z, a_z * normal, a_z * omega * jerk, along, rate)


@compiled_inline
def height(c, sine, cosine):
    """Position normal to the track, m."""
    return -(c.a_z / (c.omega * c.omega) * (cosine + sums_of(c.waves, sine, cosine).z))


@compiled_inline
def rise(c, sine, cosine):
    """Velocity normal to the track, m/s."""
    return c.a_z / c.omega * (sine + sums_of(c.waves, sine, cosine).vz)


@compiled
def height_and_rise(c, sine, cosine):
    """Position (m) and velocity (m/s) normal to the track, for callers in Python."""
    return height(c, sine, cosine), rise(c, sine, cosine)


@compiled_inline
def lift_share(c, sine, cosine):
    """Acceleration normal to the track, divided by a_z."""
    # Certificates pass numbers whose sums have no float.
    return cosine if c.waves is None else cosine + sums_of(c.waves, sine, cosine).az


@compiled_inline
def lift(c, sine, cosine):
    """Acceleration normal to the track, m/s²."""
    return c.a_z * lift_share(c, sine, cosine)


@compiled_inline
def surface(c, sine, cosine):
    """Height (m) and its rate (m/s), for the motion along the track.

    The last bit of the height differs from `height`, because it is divided by ω twice. Results that have been published
    with the one or the other keep their digits.
    """
    speed_z, added = c.a_z / c.omega, sums_of(c.waves, sine, cosine)
    return -speed_z / c.omega * (cosine + added.z), speed_z * (sine + added.vz)


@compiled_inline
def rise_between(c, from_sine, from_cosine, sine, cosine):
    """Change of the velocity normal to the track (m/s) from one phase to another."""
    # Without harmonics, the difference in brackets is 0.0, and the compiler drops it.
    turn = sine - from_sine - (sums_of(c.waves, from_sine, from_cosine).vz - sums_of(c.waves, sine, cosine).vz)
    return c.a_z / c.omega * turn


@compiled_inline
def amplitudes(a_x, a_z, omega):
    """The amplitudes of the fundamental by which Shapes are multiplied (m, m/s, m/s, m/s²); the first is negative."""
    return Shapes(-(a_z / (omega * omega)), a_z / omega, a_x / omega, a_x)


@compiled_inline
def shapes(sine, cosine, sine_along, cosine_along):
    """The Shapes of the fundamental, for sine and cosine of its phases normal to the track and along it."""
    return Shapes(cosine, sine, sine_along, cosine_along)


@compiled_inline
def add_sums(shapes, sums):
    """The Shapes with harmonics."""
    return Shapes(shapes.z + sums.z, shapes.vz + sums.vz, shapes.vx + sums.vx, shapes.ax + sums.ax)


@compiled
def sums_at(harmonics, phases):
    """The Sums, float64, shape (n, 6), of a plate's packed harmonics, shape (5 h,), at phases (rad), shape (n,)."""
    sums_of_phases = np.empty((len(phases), 6))
    for i in range(len(phases)):
        sums, (sine, cosine) = NO_SUMS, sine_and_cosine(phases[i])
        for h in range(0, len(harmonics), NUMBERS):
            harmonic = numbers_at(harmonics, np.uint64(h), ONE)
            sums = add_harmonic(sums, harmonic, *multiple(int(harmonic[K]), sine, cosine))
        copy(sums_of_phases[i], sums)
    return sums_of_phases


def largest_values(functions: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """The largest values over a cycle, shape (m,), of functions of a phase (rad): from the shape (n,) to (m, n)."""
    phases = np.linspace(0.0, 2.0 * math.pi, PHASES)
    values = functions(phases)
    largest = values.max(axis=1)
    for row, highest in enumerate(values.argmax(axis=1)):
        centre, width = phases[highest], phases[1]
        for _ in range(FINER):
            close = np.linspace(centre - width, centre + width, CLOSE)
            values = functions(close)[row]
            largest[row] = max(largest[row], values.max())
            centre, width = close[values.argmax()], 2.0 * width / CLOSE
    return largest


def largest_fall(harmonics: Sequence[float]) -> float:
    """The largest downward acceleration of the plate as a share of a_z, for the packed numbers of harmonics."""
    if len(harmonics) == 0:
        return 1.0
    waves = np.array(harmonics, dtype=np.float64)
    (largest,) = largest_values(lambda phases: [-1.0] * (np.cos(phases) + Sums(*sums_at(waves, phases).T).az)[None])
    return float(largest)


def peaks(waves: np.ndarray, shift: float) -> Peaks:
    """The Peaks of a plate, for its packed harmonics, shape (5 h,), and its phase shift (rad)."""
    if len(waves) == 0:
        return Peaks(1.0, 1.0, 1.0, 1.0, 1.0)

    def sizes(phases: np.ndarray) -> np.ndarray:
        added = Sums(*sums_at(waves, phases).T)
        along, normal = np.cos(phases + shift), np.cos(phases)
        swing = np.sin(phases + shift) + added.vx
        return np.abs([along + added.x, normal + added.z, swing, along + added.ax, normal + added.az])

    return Peaks(*largest_values(sizes))


def motion(a_x: float, a_z: float, omega: float, shift: float, harmonics: np.ndarray, phase: np.ndarray) -> dict:
    """Position and velocity along the track, x and vx, and normal to it, z and vz (m, m/s), at phases (rad)."""
    added = Sums(*sums_at(harmonics, np.ravel(phase)).T.reshape(6, *phase.shape))
    return {
        "x": -(a_x / omega**2) * (np.cos(phase + shift) + added.x),
        "vx": (a_x / omega) * (np.sin(phase + shift) + added.vx),
        "z": -(a_z / omega**2) * (np.cos(phase) + added.z),
        "vz": (a_z / omega) * (np.sin(phase) + added.vz),
    }


@compiled_inline
def ahead(c, sine, cosine):
    """Sine and cosine of the phase of the fundamental along the track, θ + ε."""
    return add_phases(sine, cosine, c.sin_shift, c.cos_shift)


@compiled_inline
def speed(c, sine, cosine):
    """Velocity along the track, m/s."""
    return c.a_x / c.omega * (ahead(c, sine, cosine)[0] + sums_of(c.waves, sine, cosine).vx)


@compiled_inline
def speed_between(c, from_sine, from_cosine, sine, cosine):
    """Change of the velocity along the track (m/s) from one phase to another."""
    turn = ahead(c, sine, cosine)[0] - ahead(c, from_sine, from_cosine)[0]
    turn -= sums_of(c.waves, from_sine, from_cosine).vx - sums_of(c.waves, sine, cosine).vx
    return c.a_x / c.omega * turn


@compiled_inline
def path_between(c, from_sine, from_cosine, sine, cosine):
    """Distance along the track (m) from one phase to another."""
    turn = ahead(c, sine, cosine)[1] - ahead(c, from_sine, from_cosine)[1]
    turn -= sums_of(c.waves, from_sine, from_cosine).x - sums_of(c.waves, sine, cosine).x
    return -(c.a_x / c.omega / c.omega * turn)


@compiled_inline
def pull_share(c, sine, cosine):
    """Acceleration along the track, divided by a_x."""
    return ahead(c, sine, cosine)[1] + sums_of(c.waves, sine, cosine).ax


@compiled_inline
def keeps_direction(c, begin, end, turn):
    """Whether the acceleration along the track keeps its sign while the phase advances by `turn` (rad).

    begin, end : `pull_share` at both ends

    A fundamental alone keeps its sign where it has it at both ends of less than half a cycle.
    """
    if c.waves is not None:
        return begin * end > 0.0 and abs(begin) + abs(end) > c.bounds.pull_rate * turn
    return begin * end > 0.0 and turn < math.pi


def recurrence(n: int, *, harmonics: bool) -> list[str]:
    """Source of the coefficients n of LIFT_W (x) and n + 1 of cosine (c) and sine (s), from w and coefficients n.

    With `harmonics`, also of their rows and of NORMAL and ALONG, which are in memory because their number is not known.
    These lines use the names of `contact_law.hertz_source`.
    """
    lines = [
        f"x{n} = {product('c', 'w', n)}",
        f"sine_w = {product('s', 'w', n)}",
        f"turn = omega * {1.0 / (n + 1)!r}",
        f"c{n + 1} = -turn * sine_w",
        f"s{n + 1} = turn * x{n}",
    ]
    if not harmonics:
        return lines
    cosine_w, sine_w = (
        total([(f"series[{row} + np.uint64({k}) * lanes]", f"w{n - k}") for k in range(n + 1)])
        for row in ("cosine", "sine")
    )
    return [
        *lines,
        f"pull_w = x{n} * cos_shift - sine_w * sin_shift",
        "for h in range(harmonics):",
        "    cosine, sine, numbers = rows_of_wave(waves, h, lanes)",
        f"    cosine_w, sine_w = {cosine_w}, {sine_w}",
        "    k, along_cosine, along_sine, normal_cosine, normal_sine = numbers_at(series, numbers, lanes)",
        f"    series[cosine + np.uint64({n + 1}) * lanes] = -turn * k * sine_w",
        f"    series[sine + np.uint64({n + 1}) * lanes] = turn * k * cosine_w",
        f"    x{n} += normal_cosine * cosine_w - normal_sine * sine_w",
        "    pull_w += along_cosine * cosine_w - along_sine * sine_w",
        f"series[at + np.uint64({NORMAL + n + 1}) * lanes] = turn * x{n}",
        f"series[at + np.uint64({ALONG + n + 1}) * lanes] = turn * pull_w",
    ]


@compiled_inline
def rows_of_wave(waves, h, lanes):
    """The rows for cosine and sine of harmonic h, and its numbers; `waves` is the first row of the first harmonic."""
    cosine = waves + np.uint64(h * WAVE) * lanes
    sine = cosine + np.uint64(SIZE) * lanes
    return cosine, sine, sine + np.uint64(SIZE) * lanes


@compiled_inline
def begin_waves(series, at, waves, lanes, harmonics, cos_shift, sin_shift, sine, cosine):
    """Write the first coefficients of the rows of harmonics, whose numbers are there, and of NORMAL and ALONG."""
    sums = NO_SUMS
    for h in range(harmonics):
        cosine_row, sine_row, numbers = rows_of_wave(waves, h, lanes)
        harmonic = numbers_at(series, numbers, lanes)
        s, c = multiple(int(harmonic[K]), sine, cosine)
        sums = add_harmonic(sums, harmonic, s, c)
        series[cosine_row], series[sine_row] = c, s
    series[at + np.uint64(NORMAL) * lanes] = sine + sums.vz
    series[at + np.uint64(ALONG) * lanes] = sine * cos_shift + cosine * sin_shift + sums.vx


@compiled_inline
def write_waves(waves, series, first, lanes):
    """Write the numbers of Waves behind their rows, of which `first` is the first one; nothing for None."""
    if waves is not None:
        for h in range(waves.count):
            row = rows_of_wave(first, h, lanes)[2]
            for number in numbers_of(waves, h):
                series[row] = number
                row += lanes


@compiled_into_callers
def turned(series, w, cosine, sine, n):
    """Coefficients n of cosine and sine times w, from their rows and the row of w."""
    cosine_w = sine_w = 0.0
    for k in range(n + 1):
        later = series[place(w, n - k)]
        cosine_w += series[place(cosine, k)] * later
        sine_w += series[place(sine, k)] * later
    return cosine_w, sine_w


@compiled_inline
def begin_series(c, waves, series, at, sine, cosine):
    """Write the first coefficients of a step's rows for a plate with Waves, or None."""
    series[at + SINE], series[at + COSINE] = sine, cosine
    if waves is not None:
        write_waves(waves, series, WAVES, ONE)
        begin_waves(series, np.uint64(at), WAVES, ONE, waves.count, c.cos_shift, c.sin_shift, sine, cosine)


@compiled_inline
def extend_series(c, waves, series, at, n):
    """Write coefficient n of LIFT_W and n + 1 of the plate's other rows, from the row W and coefficients up to n."""
    inverse = 1.0 / (n + 1)
    lift_w, sine_w = turned(series, at + W, at + COSINE, at + SINE, n)
    series[at + COSINE + n + 1] = -c.omega * sine_w * inverse
    series[at + SINE + n + 1] = c.omega * lift_w * inverse
    if waves is not None:
        pull_w = lift_w * c.cos_shift - sine_w * c.sin_shift
        for h in range(waves.count):
            cosine, sine, _ = rows_of_wave(WAVES, h, ONE)
            cosine_w, sine_w = turned(series, at + W, cosine, sine, n)
            k, along_cosine, along_sine, normal_cosine, normal_sine = numbers_of(waves, h)
            turn = k * c.omega * inverse
            series[place(cosine, n + 1)], series[place(sine, n + 1)] = -turn * sine_w, turn * cosine_w
            lift_w += normal_cosine * cosine_w - normal_sine * sine_w
            pull_w += along_cosine * cosine_w - along_sine * sine_w
        series[at + NORMAL + n + 1] = c.omega * lift_w * inverse
        series[at + ALONG + n + 1] = c.omega * pull_w * inverse
    series[at + LIFT_W + n] = lift_w


@compiled_inline
def series_length(waves, series, at, lanes, tolerance):
    """The s up to which the last terms of a step's velocities of the plate are below the tolerance; inf without waves.

    The fundamental's terms are in contact.limiting_term.
    """
    if waves is None:
        return math.inf
    normal, along = series[at + np.uint64(NORMAL + ORDER) * lanes], series[at + np.uint64(ALONG + ORDER) * lanes]
    last = max(abs(normal), abs(along))
    return (tolerance / last) ** (1.0 / ORDER) if last > 0.0 else math.inf


@compiled_inline
def expand_velocities(c, waves, series, at, row, along, normal, speed, time):
    """Fill a row with the series of along ẋ_s + normal ż_s + speed v + time t along a step."""
    straight = along * c.a_x / c.omega
    if waves is not None:
        for n in range(ORDER + 1):
            plate = straight * series[place(at + ALONG, n)] + normal * c.a_z / c.omega * series[place(at + NORMAL, n)]
            series[place(row, n)] = plate + speed * series[place(at + V, n)] + time * series[place(at + T, n)]
        return
    straight, turned_part = straight * c.cos_shift + normal * c.a_z / c.omega, straight * c.sin_shift
    for n in range(ORDER + 1):
        velocity = straight * series[place(at + SINE, n)] + speed * series[place(at + V, n)]
        series[place(row, n)] = velocity + time * series[place(at + T, n)]
    if turned_part != 0.0:  # a loop of its own, because the paper's conveyor does not need it
        for n in range(ORDER + 1):
            series[place(row, n)] += turned_part * series[place(at + COSINE, n)]


@compiled_inline
def add_pull(c, waves, series, at, row, direction, slack):
    """Add the series of w (direction ẍ_s + slack) along a step to a row.

    The product of w and an acceleration is the derivative of the velocity in the variable s.
    """
    pull = direction * c.a_x
    if waves is not None:
        for n in range(ORDER):
            plate = pull / c.omega * (n + 1) * series[place(at + ALONG, n + 1)]
            series[place(row, n)] += plate + slack * series[place(at + W, n)]
        return
    straight, turned_part = pull * c.cos_shift, pull * c.sin_shift / c.omega
    for n in range(ORDER):
        total = series[place(row, n)] + straight * series[place(at + LIFT_W, n)]
        series[place(row, n)] = total + slack * series[place(at + W, n)]
    if turned_part != 0.0:
        for n in range(ORDER):
            series[place(row, n)] += turned_part * (n + 1) * series[place(at + COSINE, n + 1)]
