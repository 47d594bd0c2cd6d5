const ORDER = 16;
const SIZE = ORDER + 2; // the last coefficient is zero, so that `search` can take third derivatives of every term

/* The solver cannot follow the part any further. */
class GaveUp extends Error {}

// A search that begins at a root skips at least this part of the step, so that it does not find the root again.
const LEAVE = 1e-6;
// An iteration that converges quadratically ends at corrections of this relative size.
const CLOSE = 1e-9;
// The sign of a value below this part of the sum of all terms is rounding noise.
const NOISE = 1e-15;
const FOUND = 0;
const ABSENT = 1;
const OPEN = 2;
const shifted = new Float64Array(SIZE);

function value(p, s) {
  let sum = p[ORDER];
  for (let n = ORDER - 1; n >= 0; n--) sum = sum * s + p[n];
  return sum;
}

/* The value and its first and second derivatives. */
function derivatives(p, s) {
  let f = p[ORDER];
  let slope = 0;
  let half = 0;
  for (let n = ORDER - 1; n >= 0; n--) {
    half = half * s + slope;
    slope = slope * s + f;
    f = f * s + p[n];
  }
  return [f, slope, 2 * half];
}

/* The root of a polynomial that changes its sign once between `low` and `high`, by safeguarded Newton steps. */
function rootOfCrossing(p, low, high) {
  const close = CLOSE * Math.max(Math.abs(low), Math.abs(high));
  const fLow = value(p, low);
  const fHigh = value(p, high);
  const sign = fHigh > 0 ? 1 : -1;
  let s = fHigh !== fLow ? high - (fHigh * (high - low)) / (fHigh - fLow) : high;
  for (let k = 0; k < 200; k++) {
    const [f, slope] = derivatives(p, s);
    if (sign * f > 0) high = s;
    else low = s;
    const following = slope !== 0 ? s - f / slope : low;
    if (Math.abs(following - s) <= close) return Math.min(Math.max(following, low), high);
    s = low < following && following < high ? following : 0.5 * (low + high);
  }
  return s;
}

/* Search for the first root in (start, end] with parabolas that lie below the polynomial, so that no root is missed.
   While `shortest` > 0, the search is still leaving the root at which it began. The answer is FOUND with the root,
   ABSENT, or OPEN where the parabolas are too narrow to advance. */
function search(p, start, end, shortest, noise) {
  let second = 0;
  let third = 0;
  let power = 1;
  for (let n = 2; n <= ORDER; n++) {
    second += n * (n - 1) * Math.abs(p[n]) * power;
    third += (n + 1) * n * (n - 1) * Math.abs(p[n + 1]) * power;
    power *= end;
  }
  let s = start;
  let [f, slope, bend] = derivatives(p, s);
  for (let k = 0; k < 60; k++) {
    f = Math.max(f, 0);
    const left = end - s;
    const lowest = Math.max(-second, bend - third * left);
    const highest = Math.min(second, bend + third * left);
    if (slope >= 0 && slope + Math.min(lowest, 0) * left >= 0) return { answer: ABSENT, s: end, shortest: 0 };
    if (slope + Math.max(highest, 0) * left < 0) {
      // The polynomial falls from here on, so its sign at the end decides.
      const low = s + shortest;
      if (low >= end || value(p, end) > (shortest > 0 ? -noise : 0)) return { answer: ABSENT, s: end, shortest: 0 };
      return { answer: FOUND, s: value(p, low) <= 0 ? low : rootOfCrossing(p, low, end), shortest: 0 };
    }
    const root = Math.sqrt(Math.max(slope * slope - 2 * lowest * f, 0));
    let advance = 0;
    if (slope > 0) advance = (slope + root) / -lowest;
    else if (f > 0) advance = (2 * f) / (root - slope);
    if (shortest === 0 && advance <= CLOSE * end) return { answer: FOUND, s: s + advance, shortest: 0 };
    if (s + Math.max(advance, shortest) > end) return { answer: ABSENT, s: end, shortest };
    s += Math.max(advance, shortest);
    [f, slope, bend] = derivatives(p, s);
    if (shortest > 0 && Math.abs(f) <= noise) shortest *= 2;
    else if (f <= 0) return { answer: FOUND, s, shortest: 0 };
    else shortest = 0;
  }
  return { answer: OPEN, s, shortest };
}

/* First root in (start, end] of a polynomial that is positive just after `start`; Infinity if there is none. */
function firstRoot(p, start, end, leave) {
  let reach = 0;
  let power = end;
  for (let n = 1; n <= ORDER; n++) {
    reach += Math.abs(p[n]) * power;
    power *= end;
  }
  if (p[0] > reach || reach === 0) return Infinity;
  const noise = NOISE * (Math.abs(p[0]) + reach);
  let { answer, s, shortest } = search(p, start, end, leave * end, noise);
  let piece = end - s;
  for (let k = 0; k < 1000; k++) {
    if (answer === FOUND) return s;
    if (answer === ABSENT && s >= end) return Infinity;
    // Expand about s: the bounds on a shorter piece are tighter.
    piece = Math.min(piece * (answer === ABSENT ? 2 : 0.25), end - s);
    shifted.set(p);
    for (let i = 0; i < ORDER; i++) for (let n = ORDER - 1; n >= i; n--) shifted[n] += s * shifted[n + 1];
    const found = search(shifted, 0, piece, shortest, noise);
    ({ answer, shortest } = found);
    s = answer === ABSENT && piece === end - s ? end : s + found.s;
  }
  throw new GaveUp("the search for a root of a contact step came to no end");
}
