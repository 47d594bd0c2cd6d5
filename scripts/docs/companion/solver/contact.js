/* Contact: the motion normal to the track, by Taylor series in a variable in which it is analytic. With the penetration
   w² and the time dt = w ds the equations of motion are polynomial,

       w' = v/2,   t' = w,   v' = w (g cos α + a_z cos θ - (d_c/m) v) - (k_c/m) w^(2p+1),   θ' = ω w.

   Each step is one Taylor polynomial in s; impact, separation, slip and stick are roots of polynomials. */

// Events that end a contact step before its full length.
const NOTHING = 0;
const SEPARATION = 1;
const FORCE_SIGN = 2;
const END_OF_CYCLE = 3;
// In a step that begins with an impact, where w = 0 as well, the search for a separation skips this part.
const LEAVE_IMPACT = 1e-6;

// Series that only the current step needs: the phase, w², w^(2p+1), products with w, and a polynomial to search.
const rooms = Array.from({ length: 7 }, () => new Float64Array(SIZE));
const [sines, cosines, squares, springs, sinesW, cosinesW, scratch] = rooms;

/* Contact force per mass at w = √penetration and the approach speed v (Eq. 9). */
function force(c, w, v) {
  const spring = c.exponent === 1.5 ? w * w * w : Math.pow(Math.max(w, 0), 2 * c.exponent);
  return c.stiffness * spring + c.damping * v;
}

/* Coefficient n of the product of two series. */
function product(a, b, n) {
  let sum = 0;
  for (let k = 0; k <= n; k++) sum += a[k] * b[n - k];
  return sum;
}

/* Coefficient n ≥ 1 of w^exponent from those below it, for w_0 > 0. */
function powerTerm(w, power, exponent, n) {
  let sum = 0;
  for (let k = 1; k <= n; k++) sum += (k * exponent - (n - k)) * w[k] * power[n - k];
  return sum / (n * w[0]);
}

/* Taylor series of w, t and v from their values at s = 0; `free` leaves the contact force out. */
function expand(c, w0, v0, sine0, cosine0, free) {
  const w = new Float64Array(SIZE);
  const t = new Float64Array(SIZE);
  const v = new Float64Array(SIZE);
  const stiffness = free ? 0 : c.stiffness;
  const damping = free ? 0 : c.damping;
  const exponent = 2 * c.exponent + 1;
  w[0] = w0;
  v[0] = v0;
  sines[0] = sine0;
  cosines[0] = cosine0;
  squares[0] = w0 * w0;
  for (let n = 0; n < ORDER; n++) {
    const inverse = 1 / (n + 1);
    w[n + 1] = 0.5 * v[n] * inverse;
    t[n + 1] = w[n] * inverse;
    squares[n + 1] = product(w, w, n + 1);
    if (c.exponent === 1.5) springs[n] = product(squares, squares, n);
    else if (c.exponent === 1) springs[n] = product(squares, w, n);
    else if (w0 <= c.edgeW) springs[n] = 0;
    else springs[n] = n === 0 ? Math.pow(w0, exponent) : powerTerm(w, springs, exponent, n);
    sinesW[n] = product(sines, w, n);
    cosinesW[n] = product(cosines, w, n);
    cosines[n + 1] = -c.omega * sinesW[n] * inverse;
    sines[n + 1] = c.omega * cosinesW[n] * inverse;
    // With the derivative v w of w², the damping needs no product of v and w.
    v[n + 1] = (c.gravity * w[n] + c.aZ * cosinesW[n] - stiffness * springs[n]) * inverse - damping * squares[n + 1];
  }
  return { w, t, v };
}

/* Fill `scratch` with the series of w F_c/m, times `scale`. */
function expandForce(c, scale) {
  for (let n = 0; n < ORDER; n++) {
    scratch[n] = scale * (c.stiffness * springs[n] + c.damping * (n + 1) * squares[n + 1]);
  }
  scratch[ORDER] = 0;
}

/* Length in s at which the last two terms of the series are below the tolerance, relative to the speed of an impact
   with the present energy or to that of the part at rest, whichever is larger. */
function stepLength(c, v, w0, v0) {
  const potential = Math.pow(w0, 2 * c.exponent + 2);
  const scale = Math.max(Math.sqrt(v0 * v0 + (2 * c.stiffness * potential) / (c.exponent + 1)), c.scaleV);
  const allowed = c.tolerance * scale;
  const phase = scale * Math.max(Math.abs(sines[ORDER]), Math.abs(cosines[ORDER]));
  const last = Math.max(Math.abs(v[ORDER]), phase);
  const before = Math.abs(v[ORDER - 1]);
  let length = 1e300;
  if (before > 0) length = Math.pow(allowed / before, 1 / (ORDER - 1));
  if (last * length > before) length = Math.min(length, Math.pow(allowed / last, 1 / ORDER));
  if (c.edgeW > 0 && springs[0] > 0) {
    // Beyond the radius of convergence of w^(2p+1), v may still be accurate, but not the sign of the force.
    const ofSpring = c.stiffness * Math.abs(springs[ORDER - 1]);
    const share = c.tolerance * (c.stiffness * springs[0] + w0 * (c.damping * Math.abs(v0) + c.gravity));
    length = Math.min(length, Math.pow(share / ofSpring, 1 / (ORDER - 1)));
  }
  return length;
}

/* Expand the motion from w0 ≥ 0, v0 and find where its step ends. `pulled`: the contact force is negative. */
function contactStep(c, w0, v0, sine0, cosine0, pulled) {
  const { w, t, v } = expand(c, w0, v0, sine0, cosine0, pulled && c.tension === "clip");
  let length = stepLength(c, v, w0, v0);
  let event = NOTHING;
  const wEnd = value(w, length);
  const vEnd = value(v, length);
  if (c.edgeW > 0 && w0 <= c.edgeW && wEnd > c.edgeW) {
    for (let n = 0; n < SIZE; n++) scratch[n] = -w[n];
    scratch[0] += c.edgeW * (1 + 1e-9);
    length = Math.min(length, firstRoot(scratch, 0, length, LEAVE));
  } else if (wEnd <= 0) {
    // w starts upwards at an impact and falls through zero once: w'' has the sign of w where the plate presses on.
    length = rootOfCrossing(w, w0 > 0 ? 0 : LEAVE_IMPACT * length, length);
    event = SEPARATION;
  } else if (v0 < 0 && vEnd > 0) {
    const root = firstRoot(w, 0, length, LEAVE);
    if (root <= length) {
      length = root;
      event = SEPARATION;
    }
  }
  if (c.tension !== "allow" && c.damping > 0) {
    expandForce(c, pulled ? -1 : 1);
    // The series has the factor w, and so a root of its own at a separation.
    const end = event === SEPARATION ? length * (1 - LEAVE_IMPACT) : length;
    const root = firstRoot(scratch, 0, end, LEAVE);
    if (root < end) {
      length = root;
      event = FORCE_SIGN;
    }
  }
  return { w, t, v, length, event };
}

/* The s in [0, length] of a contact step at which the time since its start is `tau`. */
function invertTime(step, length, tau) {
  const total = value(step.t, length);
  if (tau >= total) return length; // also for a step that is too short to take time
  let low = 0;
  let high = length;
  let s = length * Math.max(tau / total, 0);
  for (let k = 0; k < 100; k++) {
    const error = value(step.t, s) - tau;
    const w = value(step.w, s);
    if (error > 0) high = s;
    else low = s;
    const newton = w > 0 ? s - error / w : low;
    const following = low < newton && newton < high ? newton : 0.5 * (low + high);
    if (Math.abs(following - s) <= 4e-16 * length) return following;
    s = following;
  }
  return s;
}

// Parts of a contact step in each of which the force has at most one maximum, and the share of the step to which its
// place is found: the relative error of the force is about the square of it.
const PARTS = 4;
const PEAK_WIDTH = 1e-6;

/* Largest contact force per mass in a part of a contact step. */
function largestForce(c, step, begin, end) {
  const forceAt = (s) => force(c, value(step.w, s), value(step.v, s));
  const places = Array.from({ length: PARTS + 1 }, (_, k) => begin + ((end - begin) * k) / PARTS);
  const forces = places.map(forceAt);
  const best = forces.indexOf(Math.max(...forces));
  let [low, high] = [places[Math.max(best - 1, 0)], places[Math.min(best + 1, PARTS)]];
  while (high - low > PEAK_WIDTH * step.length) {
    const third = (high - low) / 3;
    if (forceAt(low + third) < forceAt(high - third)) low += third;
    else high -= third;
  }
  return Math.max(forces[best], forceAt(0.5 * (low + high)));
}
