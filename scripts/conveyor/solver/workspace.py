"""The layout of a workspace: an array of rows of Taylor coefficients (see polynomial).

The row SPARE is for one more polynomial; callers pass it to the functions that fill it. HARMONICS is the first of the
rows for cosine and sine of each harmonic of the plate, which last as long as one expansion. Each contact step has STEP
coefficients from its first row on, in the rows at + W, at + T and so forth.
"""

from ..parameters import HARMONIC, MOST_HARMONICS
from .polynomial import FIRST_ROW, SIZE

SPARE = FIRST_ROW
HARMONICS = SPARE + SIZE
WAVE = 2 * SIZE + len(HARMONIC)
FIRST = HARMONICS + MOST_HARMONICS * WAVE
# The rows of a step: w, t, v, sine and cosine of the phase, w², w^(2p+1), and w times the plate's normal acceleration,
# divided by its amplitude. The last two belong to plates with harmonics: their velocities normal to the track and along
# it, divided by the amplitudes of the fundamental.
W, T, V, SINE, COSINE, SQUARE, SPRING, LIFT_W, NORMAL, ALONG = range(0, 10 * SIZE, SIZE)
# A row of a step for its beginning and its end, see repeated_steps.
BEGIN_AND_END = 10 * SIZE
STEP = 11 * SIZE
