"use strict";
/* The motion of a part on a vibrating plate, as scripts/conveyor computes it: no step of time, no DOM.

   In the air the part follows a parabola. In contact, with the penetration w² and the time dt = w ds, the equations of
   motion are polynomial,

       w' = v/2,   t' = w,   v' = w (g + a_z cos θ - (d_c/m) v) - (k_c/m) w^(2p+1),   θ' = ω w,

   and every step is one Taylor polynomial in s, on which impact, separation, slip and stick are roots. A run is the
   list of these pieces: it can be looked at anywhere, to all its digits.

   SI units throughout. A parameter is known by its name in scripts/conveyor/model.py; z0 may be "conveyor" (Eq. 15). */
const solver = (() => {
  const TENSIONS = ["allow", "frictionless", "clip"];
  const ORDER = 16;
  const SIZE = ORDER + 2; // the tail is zero: the third derivative at the highest order needs no case of its own

  // Pieces of a run after which it is given up: a page must answer.
  const MAX_PIECES = 100000;
  // Cycles begin at the plate's top, where a part that leaves the plate at all is in the air.
  const BEGIN_OF_CYCLE = -Math.PI;

  /* The solver cannot follow the part any further: nothing that lies behind may be shown. */
  class GaveUp extends Error {}

  // ---------------------------------------------------------------------------------------------------- polynomials

  // A root that a search starts on is left behind by at least this part of the step, so that it is not found twice.
  const LEAVE = 1e-6;
  // Corrections of this relative size end an iteration that converges quadratically: the next one would be its square.
  const CLOSE = 1e-9;
  // Values below this part of the sum of all terms have no sign that one could trust.
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

  /* Look for the first root in (start, end] with parabolas that lie below the polynomial: no root can be jumped over,
     whatever the signs at the ends are. While `shortest` > 0 the search leaves a root on which it began. The answer is
     FOUND with the root, ABSENT, or OPEN where the parabolas are too narrow to get on. */
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
        // Falling from here on: the sign at the end decides.
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

  /* First root in (start, end] of a polynomial that is positive just behind `start`; Infinity if there is none. */
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
      // Bounds on a shorter piece, from the expansion about its start, are tighter.
      piece = Math.min(piece * (answer === ABSENT ? 2 : 0.25), end - s);
      shifted.set(p);
      for (let i = 0; i < ORDER; i++) for (let n = ORDER - 1; n >= i; n--) shifted[n] += s * shifted[n + 1];
      const found = search(shifted, 0, piece, shortest, noise);
      ({ answer, shortest } = found);
      s = answer === ABSENT && piece === end - s ? end : s + found.s;
    }
    throw new GaveUp("the search for a root of a contact step came to no end");
  }

  // ----------------------------------------------------------------------------------------------------- the model

  /* The constants of one conveyor in the form in which the equations need them, forces per mass. */
  function constants(parameters, tolerance) {
    const omega = 2 * Math.PI * parameters.frequency;
    const aX = parameters.acceleration * Math.cos(parameters.angle);
    const aZ = parameters.acceleration * Math.sin(parameters.angle);
    const { mass, exponent, friction, tension, psi0, inclination, phase_shift: shift } = parameters;
    const gravity = parameters.gravity * Math.cos(inclination);
    const stiffness = parameters.stiffness / mass;
    const depth = Math.pow(gravity / stiffness, 1 / exponent); // static penetration
    const scaleV = Math.sqrt(2 * gravity * depth);
    return {
      omega,
      period: 1 / parameters.frequency,
      psi0,
      aX,
      aZ,
      speedX: aX / omega,
      speedZ: aZ / omega,
      height: aZ / (omega * omega),
      sineShift: Math.sin(shift),
      cosineShift: Math.cos(shift),
      gravity, // normal to the track
      downhill: parameters.gravity * Math.sin(inclination),
      mass,
      stiffness,
      damping: parameters.damping / mass,
      exponent,
      friction,
      staticFriction: parameters.static_friction ?? friction,
      tension,
      tolerance,
      scaleW: Math.sqrt(depth),
      scaleV,
      // Below this w a spring of any other power than these weighs nothing, and is switched off: see `expand`.
      edgeW: exponent === 1.5 || exponent === 1 ? 0 : Math.pow((tolerance * gravity) / stiffness, 0.5 / exponent),
      // Slower impacts and separations cannot be told from rest at this tolerance, nor weaker contact forces from none.
      restSpeed: 10 * tolerance * scaleV,
      restForce: 10 * tolerance * gravity,
    };
  }

  /* Motion of the plate along the track at a phase θ that is given by its sine and cosine: position x = -(a_x/ω²)
     cos(θ + ε), velocity vx, and the friction force per mass ẍ_s + g sin α that lets the part stick. */
  function alongTrack(c, sine, cosine) {
    const shiftedSine = sine * c.cosineShift + cosine * c.sineShift;
    const shiftedCosine = cosine * c.cosineShift - sine * c.sineShift;
    return {
      x: (-c.speedX / c.omega) * shiftedCosine,
      vx: c.speedX * shiftedSine,
      holding: c.aX * shiftedCosine + c.downhill,
    };
  }

  /* Position and velocity of the plate (Eqs. 3, 4 and 10) at a time. */
  function plate(c, time) {
    const theta = c.omega * time + c.psi0;
    const [sine, cosine] = [Math.sin(theta), Math.cos(theta)];
    const { x, vx } = alongTrack(c, sine, cosine);
    return { x, vx, z: -c.height * cosine, vz: c.speedZ * sine };
  }

  // -------------------------------------------------------------------------------------------------------- flight

  const EPSILON = Number.EPSILON;

  /* Gap and its rate after the time `tau` of a flight from z, vz at the phase `theta`. */
  function gap(c, z, vz, tau, theta) {
    const phase = theta + c.omega * tau;
    return [
      z + (vz - 0.5 * c.gravity * tau) * tau + c.height * Math.cos(phase),
      vz - c.gravity * tau - c.speedZ * Math.sin(phase),
    ];
  }

  /* Time in which a part with an upward velocity falls by a height ≥ 0, without cancellation. */
  function timeOfFall(velocity, height, gravity) {
    const root = Math.sqrt(velocity * velocity + 2 * gravity * height);
    return velocity > 0 ? (velocity + root) / gravity : (2 * height) / (root - velocity);
  }

  // Steps after which a search for an impact is lost, and so is a gap below zero by more than this many roundings.
  const MAX_STEPS = 100000;
  const LOST = 1e6;

  /* Duration of a flight from the gap q ≥ 0 with its rate, and the speed of approach at its end; infinite if there is
     no impact before `limit`. Above the plate's highest point nothing can be hit. Below it the parabola of the bound
     q̈ ≥ -(g + a_z) reaches the plate before the part does: steps to its root cannot jump over an impact. */
  function nextImpact(c, z, vz, q, rate, theta, limit) {
    const bound = c.gravity + c.aZ;
    let tau = 0;
    if (q <= 4 * EPSILON * (Math.abs(z) + c.height)) {
      // From the plate the parabola has no room; the bound a_z ω of the third derivative and the actual q̈ do.
      tau = (2 * Math.max(rate, 0)) / bound;
      const jerk = c.aZ * c.omega;
      const half = -0.5 * (c.gravity + c.aZ * Math.cos(theta));
      const root = Math.sqrt(half * half + (2 / 3) * jerk * Math.max(rate, 0));
      if (half < 0) tau = Math.max(tau, (2 * Math.max(rate, 0)) / (root - half));
      else if (jerk > 0) tau = Math.max(tau, (3 * (half + root)) / jerk);
      tau = Math.max(tau, 1e-9 / c.omega);
      if (tau >= limit) return { tau: Infinity, speed: 0 };
      [q, rate] = gap(c, z, vz, tau, theta);
    }
    for (let k = 0; k < MAX_STEPS; k++) {
      const velocity = vz - c.gravity * tau;
      const height = z + 0.5 * (vz + velocity) * tau;
      // What the longest way so far, up or down, has lost of its digits.
      const lengths = Math.abs(z) + Math.abs(vz * tau) + 0.5 * c.gravity * tau * tau + c.height;
      const rounding = 4 * EPSILON * lengths;
      if (q <= rounding && rate <= 0) return { tau, speed: -rate };
      if (q < -LOST * rounding) break;
      if (q < 0) return { tau, speed: 0 };
      let advance = 0;
      if (height > c.height + rounding) advance = timeOfFall(velocity, height - c.height, c.gravity);
      if (advance <= 2 * EPSILON * tau) {
        advance = timeOfFall(rate, q, bound);
        if (advance <= 2 * EPSILON * tau) return { tau, speed: Math.max(-rate, 0) };
      }
      tau += advance;
      if (tau >= limit) return { tau: Infinity, speed: 0 };
      [q, rate] = gap(c, z, vz, tau, theta);
    }
    throw new GaveUp("the search for the next impact came to no end");
  }

  // ------------------------------------------------------------------------------------------------------- contact

  // What ends a contact step before its full length.
  const NOTHING = 0;
  const SEPARATION = 1;
  const FORCE_SIGN = 2;
  const END_OF_CYCLE = 3;
  // A separation is searched for behind this part of a step that begins with an impact, where w = 0 as well.
  const LEAVE_IMPACT = 1e-6;

  // Room for what is needed while a step is made only: w², w^(2p+1), the phase, and a polynomial to search.
  const rooms = Array.from({ length: 7 }, () => new Float64Array(SIZE));
  const [sines, cosines, squares, springs, sinesW, cosinesW, scratch] = rooms;

  /* Contact force per mass at w = √penetration and the speed of approach v (Eq. 9). */
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
     with the present energy, and never to less than that of the part at rest. */
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
      // Behind the radius of convergence of w^(2p+1) v may still be right, but not the sign of the force.
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
    if (tau >= total) return length; // also a step that is too short to take time
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
  const PEAK_WIDTH = 1e-8;

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

  // ------------------------------------------------------------------------------------------------------ friction

  /* Where, in (start, length] of a step, the slip velocity reaches zero: a polynomial, because F_c/m = z̈_p + g cos α.
     `leave` is the part of the step by which a root at `start` is left behind. */
  function slipEnd(c, step, start, length, slip, sigma, mu, leave) {
    const speedX = sigma * c.speedX;
    const fall = mu * c.gravity - sigma * c.downhill;
    for (let n = 0; n <= ORDER; n++) {
      const plateSlip = speedX * (sines[n] * c.cosineShift + cosines[n] * c.sineShift);
      scratch[n] = plateSlip + mu * (step.v[n] - c.speedZ * sines[n]) - fall * step.t[n];
    }
    scratch[0] = 0;
    scratch[0] = sigma * slip - value(scratch, start);
    return firstRoot(scratch, start, length, leave);
  }

  /* Where, in (start, length], |ẍ_s + g sin α| exceeds μ_s F_c/m, and whether it stays so until the end. */
  function stickEnd(c, step, start, length) {
    let end = Infinity;
    let lasting = false;
    for (const direction of [-1, 1]) {
      expandForce(c, c.staticFriction);
      for (let n = 0; n < ORDER; n++) {
        const plateW = c.aX * (cosinesW[n] * c.cosineShift - sinesW[n] * c.sineShift) + c.downhill * step.w[n];
        scratch[n] += direction * plateW + c.staticFriction * c.restForce * step.w[n];
      }
      const root = firstRoot(scratch, start, length, LEAVE);
      if (root < end) {
        for (let n = 0; n < ORDER; n++) scratch[n] = -scratch[n];
        end = root;
        lasting = firstRoot(scratch, root, length, LEAVE) === Infinity;
      }
    }
    return [end, lasting];
  }

  /* Sign of the slip that follows when the slip velocity is zero, or 0 for stick (Filippov's condition). `holding` is
     the friction force per mass that stick takes, `grip` the coefficient of static friction that acts. */
  function directionAtRest(c, holding, contactForce, grip) {
    // The slack in the force keeps a part that barely touches from sticking and slipping without end.
    if (grip > 0 && Math.abs(holding) <= grip * (contactForce + c.restForce)) return 0;
    return holding < 0 ? -1 : 1;
  }

  /* Sign of the slip at an impact or at the beginning of a run in contact. */
  function direction(c, sine, cosine, vx, contactForce) {
    const track = alongTrack(c, sine, cosine);
    return Math.sign(track.vx - vx) || directionAtRest(c, track.holding, contactForce, c.staticFriction);
  }

  /* Position and velocity of the part along the track after the time `tau` of a piece in contact. */
  function moved(c, piece, tau, sine, cosine, z, vz) {
    if (piece.sigma === 0) {
      const track = alongTrack(c, sine, cosine);
      return { x: piece.x + track.x - alongTrack(c, piece.sine, piece.cosine).x, vx: track.vx };
    }
    const rub = piece.sigma * piece.mu;
    const path = z - piece.z - piece.vz * tau + 0.5 * c.gravity * tau * tau;
    return {
      x: piece.x + (piece.vx - 0.5 * c.downhill * tau) * tau + rub * path,
      vx: piece.vx - c.downhill * tau + rub * (vz - piece.vz + c.gravity * tau),
    };
  }

  // --------------------------------------------------------------------------------------------------- event loop

  /* What `follow` found. `pieces` have one law of motion each and are in order of time, as are the `events`
     {time, kind}; an impact has its speed of approach and the duration of the flight that it ends as well. `status` is
     "ok", or why the run was given up at the time `end`. */
  class Run {
    constructor(constantsOfRun, duration) {
      this.c = constantsOfRun;
      this.duration = duration;
      this.status = "ok";
      this.end = duration;
      this.pieces = [];
      this.events = [];
    }

    /* Position, velocity and forces of the part at a time from 0 to `end`, and what it does there. */
    at(time) {
      let low = 0;
      let high = this.pieces.length;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (this.pieces[middle].begin <= time) low = middle;
        else high = middle;
      }
      const piece = this.pieces[low];
      return piece.step ? inContact(this.c, piece, time) : inFlight(this.c, piece, time);
    }

    impacts() {
      return this.events.filter((event) => event.kind === "impact");
    }

    /* Mean feeding velocity over the last part of the run (Sect. 3.1). */
    meanVelocity(last) {
      return (this.at(this.duration).x - this.at((1 - last) * this.duration).x) / (last * this.duration);
    }

    /* Largest normal approach speed of the impacts in the last part of the run; 0 if there is none. */
    impactSpeed(last) {
      const from = (1 - last) * this.duration;
      return Math.max(0, ...this.impacts().map(({ time, speed }) => (time >= from ? speed : 0)));
    }

    /* Largest contact force in the last part of the run; 0 if there is none. */
    peakForce(last) {
      const from = (1 - last) * this.duration;
      let largest = 0;
      this.pieces.forEach(({ begin, step, pressing }, k) => {
        if (!step || !pressing || step === this.pieces[k - 1]?.step) return;
        const [low, high] = [from, this.duration].map((time) => invertTime(step, step.length, time - begin));
        if (low < step.length) largest = Math.max(largest, largestForce(this.c, step, low, high));
      });
      return this.c.mass * largest;
    }
  }

  function inFlight(c, piece, time) {
    const tau = time - piece.base - piece.t;
    return {
      x: piece.x + (piece.vx - 0.5 * c.downhill * tau) * tau,
      vx: piece.vx - c.downhill * tau,
      z: piece.z + (piece.vz - 0.5 * c.gravity * tau) * tau,
      vz: piece.vz - c.gravity * tau,
      contactForce: 0,
      frictionForce: 0,
      motion: "flight",
    };
  }

  function inContact(c, piece, time) {
    const { step, sigma, mu } = piece;
    const lapse = time - piece.base - piece.t;
    const s = invertTime(step, step.length, lapse);
    const theta = piece.theta + c.omega * lapse;
    const [w, v] = [value(step.w, s), value(step.v, s)];
    const [sine, cosine] = [Math.sin(theta), Math.cos(theta)];
    const z = -c.height * cosine - w * w;
    const vz = c.speedZ * sine - v;
    const contactForce = piece.pressing ? c.mass * force(c, w, v) : 0;
    const frictionForce = sigma === 0 ? c.mass * alongTrack(c, sine, cosine).holding : sigma * mu * contactForce;
    // The slip velocity ẋ_s - ẋ_p is positive where the plate is the faster one.
    const motion = sigma === 0 ? "stick" : sigma > 0 ? "lags" : "leads";
    return { ...moved(c, piece, lapse - piece.here, sine, cosine, z, vz), z, vz, contactForce, frictionForce, motion };
  }

  /* Follow one part for a `duration`. `feeding`: whether the horizontal motion is wanted. */
  function follow(parameters, duration, { tolerance, feeding = true }) {
    const run = new Run(constants(parameters, tolerance), duration);
    try {
      advance(run, parameters, feeding);
    } catch (reason) {
      if (!(reason instanceof GaveUp)) throw reason;
      run.status = reason.message;
      const last = run.pieces.at(-1);
      run.end = last ? last.begin : 0;
    }
    return run;
  }

  function advance(run, parameters, feeding) {
    const { c, pieces, duration } = run;
    // Time is kept as whole excitation cycles plus a time within the cycle.
    const turn = 2 * Math.PI;
    const offset = ((((c.psi0 - BEGIN_OF_CYCLE) % turn) + turn) % turn) / c.omega;
    let cycle = 0;
    let base = -offset;
    let t = offset;
    let theta = c.psi0;
    let sine = Math.sin(theta);
    let cosine = Math.cos(theta);
    let q = parameters.z0 === "conveyor" ? 0 : parameters.z0 + c.height * cosine;
    let vz = parameters.vz0;
    let rate = vz - c.speedZ * sine;
    let z = q - c.height * cosine;
    let x = 0;
    let vx = 0;
    let w = 0;
    let v = 0;
    let sigma = 0;
    let pulled = false;
    let leftPlate = 0; // when the flight began

    function record(event) {
      if (event.time <= duration) run.events.push(event);
    }

    function keep(piece) {
      if (pieces.length === MAX_PIECES) throw new GaveUp(`more than ${MAX_PIECES} pieces of motion`);
      pieces.push(piece);
    }

    let touching = q !== 0 ? q < 0 : rate !== 0 ? rate < 0 : c.gravity + c.aZ * cosine > 0;
    if (touching) {
      w = Math.sqrt(-q);
      v = -rate;
      pulled = c.tension !== "allow" && force(c, w, v) < 0;
      sigma = direction(c, sine, cosine, vx, force(c, w, v));
    }

    while (base + t < duration) {
      if (!touching) {
        keep({ begin: base + t, base, t, x, vx, z, vz });
        const { tau, speed } = nextImpact(c, z, vz, q, rate, theta, duration - base - t);
        if (tau === Infinity) return;
        if (!(tau >= 0)) throw new GaveUp("not finite");
        x += (vx - 0.5 * c.downhill * tau) * tau;
        vx -= c.downhill * tau;
        t += tau;
        touching = true;
        record({ time: base + t, kind: "impact", speed, flight: base + t - leftPlate });
        w = 0;
        v = speed;
        pulled = false;
        theta = BEGIN_OF_CYCLE + c.omega * t;
        sine = Math.sin(theta);
        cosine = Math.cos(theta);
        sigma = direction(c, sine, cosine, vx, c.damping * v);
      } else {
        if (w === 0 && v <= c.restSpeed) {
          // Grazing: the part touches with no speed and is either pressed on or left behind by the plate.
          const press = c.gravity + c.aZ * cosine;
          if (press > 0) {
            // At w = v = 0 the equations in s stand still. The motion leaves that point as δ = press τ²/2.
            w = 1e-9 * c.scaleW;
            v = Math.sqrt(2 * press) * w;
            t += v / press;
          } else if (v <= 0) {
            touching = false;
            [q, rate, z, vz] = [0, 0, -c.height * cosine, c.speedZ * sine];
            leftPlate = base + t;
            record({ time: base + t, kind: "separation" });
            continue;
          }
        }
        const step = contactStep(c, w, v, sine, cosine, pulled);
        let lapse = value(step.t, step.length);
        if (t + lapse > c.period) {
          lapse = c.period - t;
          step.length = invertTime(step, step.length, lapse);
          step.event = END_OF_CYCLE;
        }
        const { length, event } = step;
        const atEnd = event === END_OF_CYCLE;
        const sineEnd = atEnd ? Math.sin(BEGIN_OF_CYCLE) : value(sines, length);
        const cosineEnd = atEnd ? Math.cos(BEGIN_OF_CYCLE) : value(cosines, length);
        const wEnd = event === SEPARATION ? 0 : value(step.w, length);
        const vEnd = value(step.v, length);
        if (!(Number.isFinite(wEnd) && Number.isFinite(vEnd) && Number.isFinite(lapse))) throw new GaveUp("not finite");

        // The segments of constant slip direction within this step.
        const pressing = !(pulled && c.tension === "clip");
        const [mu, grip] = pulled ? [0, 0] : [c.friction, c.staticFriction];
        let here = { s: 0, w, v, t: 0, sine, cosine };
        let released = !feeding;
        let leave = LEAVE;
        for (;;) {
          const piece = {
            ...{ begin: base + t + here.t, base, t, theta, step, here: here.t, sine: here.sine, cosine: here.cosine },
            ...{ sigma, mu, pressing, x, vx, z: -c.height * here.cosine - here.w * here.w, vz: c.speedZ * here.sine - here.v },
          };
          keep(piece);
          let change = Infinity;
          if (!released) {
            const slip = alongTrack(c, here.sine, here.cosine).vx - vx;
            if (sigma === 0) [change, released] = stickEnd(c, step, here.s, length);
            else change = slipEnd(c, step, here.s, length, slip, sigma, mu, leave);
          }
          const changed = change < length;
          here = { s: length, w: wEnd, v: vEnd, t: lapse, sine: sineEnd, cosine: cosineEnd };
          if (changed) {
            const elapsed = value(step.t, change);
            const phase = theta + c.omega * elapsed;
            const [sine, cosine] = [Math.sin(phase), Math.cos(phase)];
            here = { s: change, w: value(step.w, change), v: value(step.v, change), t: elapsed, sine, cosine };
          }
          const [z, vz] = [-c.height * here.cosine - here.w * here.w, c.speedZ * here.sine - here.v];
          ({ x, vx } = moved(c, piece, here.t - piece.here, here.sine, here.cosine, z, vz));
          if (!changed) break;
          const track = alongTrack(c, here.sine, here.cosine);
          vx = track.vx; // exactly
          if (sigma === 0) sigma = Math.sign(track.holding) || 1;
          else sigma = directionAtRest(c, track.holding, force(c, here.w, here.v), grip);
          if (sigma === piece.sigma) {
            // No reversal: the slip cannot be told from zero here, and leaves it further on.
            leave *= 2;
          } else {
            leave = LEAVE;
            const kind = piece.sigma === 0 ? "slip" : sigma === 0 ? "stick" : "slip reversal";
            record({ time: base + t + here.t, kind });
          }
        }

        t = atEnd ? c.period : t + lapse;
        theta = BEGIN_OF_CYCLE + c.omega * t;
        [sine, cosine, w, v] = [sineEnd, cosineEnd, wEnd, vEnd];
        if (event === SEPARATION && v >= -c.restSpeed && c.gravity + c.aZ * cosine > 0) {
          v = 0;
        } else if (event === SEPARATION) {
          touching = false;
          [q, rate, z, vz] = [0, -v, -c.height * cosine, c.speedZ * sine - v];
          leftPlate = base + t;
          record({ time: base + t, kind: "separation" });
        } else if (event === FORCE_SIGN) {
          pulled = !pulled;
          record({ time: base + t, kind: pulled ? "tension begins" : "tension ends" });
        }
      }
      while (t >= c.period) {
        t -= c.period;
        cycle += 1;
        base = cycle * c.period - offset;
        theta = BEGIN_OF_CYCLE + c.omega * t;
      }
    }
  }

  // ----------------------------------------------------------------------------------------------- state of motion

  const MAX_PERIOD = 64;
  // A state repeats itself if it comes back to this distance, in units of the part at rest, and does so twice running.
  const REPEATED = 1e-6;
  // A motion that doubles its period slowly is near twice its period first: parts of a period this close are one.
  const SAME = 1e-4;
  // The second state spends most of a cycle in the air; micro-bounces of the first last a small part of it.
  const LONG_FLIGHT = 0.5;

  /* The state of motion that a start settles in within a number of excitation cycles: looked at once a cycle, it must
     repeat itself with a period of up to 64 cycles. {state: "first" or "second", period, after}, or {state: null} if it
     has not: which is not chaos, only time that did not suffice. */
  function settle(parameters, cycles, options) {
    // Most motions settle soon.
    const soon = settleWithin(parameters, Math.min(cycles, 2 * MAX_PERIOD), options);
    return soon.state ? soon : settleWithin(parameters, cycles, options);
  }

  function settleWithin(parameters, cycles, { tolerance }) {
    const run = follow(parameters, cycles / parameters.frequency, { tolerance, feeding: false });
    if (run.status !== "ok") return { state: null, status: run.status };
    const { c } = run;
    const strobes = [];
    let candidate = 0;
    let repeats = 0;
    for (let n = 1; n <= cycles; n++) {
      const time = n * c.period;
      const part = run.at(time);
      const ground = plate(c, time);
      const strobe = [part.z - ground.z, part.vz - ground.vz];
      strobes.push(strobe);
      const periods = Array.from({ length: Math.min(n - 1, MAX_PERIOD) }, (_, k) => k + 1);
      // Distance of the last state from the one `lag` cycles before, in units of the part at rest.
      const distance = (lag) => {
        const past = strobes.at(-1 - lag);
        const [height, speed] = [strobe[0] - past[0], strobe[1] - past[1]];
        return Math.max(Math.abs(height) / (c.scaleW * c.scaleW), Math.abs(speed) / c.scaleV);
      };
      const found = periods.find((period) => distance(period) <= REPEATED) || 0;
      repeats = found > 0 && found === candidate ? repeats + 1 : 0;
      candidate = found;
      if (candidate > 0 && repeats >= candidate) {
        candidate = periods.find((period) => candidate % period === 0 && distance(period) <= SAME) || candidate;
        const flights = run
          .impacts()
          .filter((impact) => impact.time > time - candidate * c.period && impact.time <= time)
          .map((impact) => impact.flight);
        const longest = Math.max(0, ...flights) / c.period;
        return { state: longest >= LONG_FLIGHT ? "second" : "first", period: candidate, after: n, status: "ok" };
      }
    }
    return { state: null, status: "ok" };
  }

  // ---------------------------------------------------------------------------------------------- the paper's Euler

  /* What explicit Euler with a fixed step finds (Sect. 3 of the paper): it steps over impacts, and its friction
     chatters where the part should stick. Every `stride`th step is kept. */
  class EulerRun {
    constructor(duration, step, stride, states) {
      this.duration = duration;
      this.interval = step * stride;
      this.states = states;
      this.status = "ok";
    }

    /* The kept state nearest to a time. */
    at(time) {
      const row = 6 * Math.min(Math.round(time / this.interval), this.states.length / 6 - 1);
      const [x, vx, z, vz, contactForce, frictionForce] = this.states.subarray(row, row + 6);
      return { x, vx, z, vz, contactForce, frictionForce };
    }

    meanVelocity(last) {
      return (this.at(this.duration).x - this.at((1 - last) * this.duration).x) / (last * this.duration);
    }
  }

  // m: a part that far from where it started has blown up.
  const FAR = 1;

  function euler(parameters, duration, step, stride) {
    const c = constants(parameters, 0);
    const steps = Math.max(1, Math.round(duration / step));
    const states = new Float64Array(6 * (Math.floor(steps / stride) + 1));
    const run = new EulerRun(duration, step, stride, states);
    let x = 0;
    let vx = 0;
    let z = parameters.z0 === "conveyor" ? -c.height * Math.cos(c.psi0) : parameters.z0;
    let vz = parameters.vz0;
    const start = z;
    for (let i = 0; i <= steps; i++) {
      const phase = c.omega * (i * step) + c.psi0;
      const sine = Math.sin(phase);
      const q = z + c.height * Math.cos(phase);
      let push = 0;
      if (q <= 0) push = force(c, Math.sqrt(-q), c.speedZ * sine - vz);
      if (push < 0 && c.tension === "clip") push = 0;
      const mu = push < 0 && c.tension === "frictionless" ? 0 : c.friction;
      const rub = mu * push * Math.sign(c.speedX * sine - vx);
      if (i % stride === 0) {
        if (!(Math.abs(z - start) < FAR)) {
          run.status = "blows up";
          return run;
        }
        states.set([x, vx, z, vz, c.mass * push, c.mass * rub], 6 * (i / stride));
      }
      x += step * vx;
      vx += step * rub;
      z += step * vz;
      vz += step * (push - c.gravity);
    }
    return run;
  }

  return { TENSIONS, constants, plate, follow, settle, euler };
})();
