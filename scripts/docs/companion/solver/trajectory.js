// A run with more pieces than this is given up, because the page must respond.
const MAX_PIECES = 100000;
// Cycles begin at the plate's top, where a part that leaves the plate is in the air.
const BEGIN_OF_CYCLE = -Math.PI;

/* A trajectory. `pieces` have one law of motion each and are in order of time, as are the `events` {time, kind}; an
   impact also has its approach speed and the duration of the flight that it ends. `status` is "ok", or the reason why
   the solver gave up at the time `end`. */
class Run {
  constructor(constantsOfRun, duration) {
    this.c = constantsOfRun;
    this.duration = duration;
    this.status = "ok";
    this.end = duration;
    this.pieces = [];
    this.events = [];
  }

  keep(piece) {
    if (this.pieces.length === MAX_PIECES) throw new GaveUp(`more than ${MAX_PIECES} pieces of motion`);
    this.pieces.push(piece);
  }

  record(event) {
    if (event.time <= this.duration) this.events.push(event);
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
  const here = inside(c, step, invertTime(step, step.length, lapse), piece.theta);
  const { sine, cosine } = here;
  const { z, vz } = normalMotion(c, here);
  const contactForce = piece.pressing ? c.mass * force(c, here.w, here.v) : 0;
  const frictionForce = sigma === 0 ? c.mass * alongTrack(c, sine, cosine).holding : sigma * mu * contactForce;
  // The slip velocity ẋ_s - ẋ_p is positive where the plate is faster.
  const motion = sigma === 0 ? "stick" : sigma > 0 ? "lags" : "leads";
  return { ...moved(c, piece, lapse - piece.here, sine, cosine, z, vz), z, vz, contactForce, frictionForce, motion };
}

/* Follow one part for a `duration`. `feeding`: whether to compute the motion along the track. */
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
  const motion = atBegin(run.c, parameters);
  while (motion.base + motion.t < run.duration) {
    if (motion.touching) touch(run, motion, feeding);
    else if (!fly(run, motion)) return;
    while (motion.t >= run.c.period) {
      motion.t -= run.c.period;
      motion.cycle += 1;
      motion.base = motion.cycle * run.c.period - motion.offset;
      motion.theta = BEGIN_OF_CYCLE + run.c.omega * motion.t;
    }
  }
}

/* The state of the part at t = 0. `base` is the time at which the present `cycle` began, `t` the time since then, and
   `theta` the phase with its `sine` and `cosine`. In flight, the part has the height z, the velocity vz, the gap q and
   its rate; `leftPlate` is the time at which the flight began. In contact, it has w = √penetration and the approach
   speed v; `pulled` is true while the contact force is negative. Along the track, it has x, vx and the sign `sigma` of
   the slip, 0 for stick. */
function atBegin(c, parameters) {
  const turn = 2 * Math.PI;
  const offset = ((((c.psi0 - BEGIN_OF_CYCLE) % turn) + turn) % turn) / c.omega;
  const [sine, cosine] = [Math.sin(c.psi0), Math.cos(c.psi0)];
  const q = parameters.z0 === "conveyor" ? 0 : parameters.z0 + c.height * cosine;
  const rate = parameters.vz0 - c.speedZ * sine;
  const motion = {
    ...{ cycle: 0, offset, base: -offset, t: offset, theta: c.psi0, sine, cosine },
    ...{ q, rate, z: q - c.height * cosine, vz: parameters.vz0, leftPlate: 0 },
    ...{ w: 0, v: 0, pulled: false, x: 0, vx: 0, sigma: 0 },
    touching: q !== 0 ? q < 0 : rate !== 0 ? rate < 0 : c.gravity + c.aZ * cosine > 0,
  };
  if (!motion.touching) return motion;
  const [w, v] = [Math.sqrt(-q), -rate];
  const push = force(c, w, v);
  return { ...motion, w, v, pulled: c.tension !== "allow" && push < 0, sigma: direction(c, sine, cosine, 0, push) };
}

/* Follow a flight to its impact. False if the run ends before. */
function fly(run, motion) {
  const { c } = run;
  const { base, t, x, vx, z, vz, q, rate, theta } = motion;
  run.keep({ begin: base + t, base, t, x, vx, z, vz });
  const { tau, speed } = nextImpact(c, z, vz, q, rate, theta, run.duration - base - t);
  if (tau === Infinity) return false;
  if (!(tau >= 0)) throw new GaveUp("not finite");
  motion.x += (vx - 0.5 * c.downhill * tau) * tau;
  motion.vx -= c.downhill * tau;
  motion.t += tau;
  motion.theta = BEGIN_OF_CYCLE + c.omega * motion.t;
  const [sine, cosine] = [Math.sin(motion.theta), Math.cos(motion.theta)];
  const sigma = direction(c, sine, cosine, motion.vx, c.damping * speed);
  Object.assign(motion, { touching: true, pulled: false, w: 0, v: speed, sine, cosine, sigma });
  const time = base + motion.t;
  run.record({ time, kind: "impact", speed, flight: time - motion.leftPlate });
  return true;
}

/* The part leaves the plate with a rate of the gap. */
function leavePlate(run, motion, rate) {
  const { c } = run;
  const time = motion.base + motion.t;
  const [z, vz] = [-c.height * motion.cosine, c.speedZ * motion.sine + rate];
  Object.assign(motion, { touching: false, q: 0, rate, z, vz, leftPlate: time });
  run.record({ time, kind: "separation" });
}

/* Follow one step of a contact. */
function touch(run, motion, feeding) {
  const { c } = run;
  const press = c.gravity + c.aZ * motion.cosine;
  if (motion.w === 0 && motion.v <= c.restSpeed) {
    // Grazing: the part touches with no speed, and the plate either presses on or leaves it behind.
    if (press > 0) {
      // At w = v = 0 the equations in s stand still. The motion leaves that point as δ = press τ²/2.
      motion.w = 1e-9 * c.scaleW;
      motion.v = Math.sqrt(2 * press) * motion.w;
      motion.t += motion.v / press;
    } else if (motion.v <= 0) {
      leavePlate(run, motion, 0);
      return;
    }
  }
  const step = contactStep(c, motion.w, motion.v, motion.sine, motion.cosine, motion.pulled);
  let lapse = value(step.t, step.length);
  if (motion.t + lapse > c.period) {
    lapse = c.period - motion.t;
    step.length = invertTime(step, step.length, lapse);
    step.event = END_OF_CYCLE;
  }
  const { length, event } = step;
  const atEnd = event === END_OF_CYCLE;
  const end = {
    s: length,
    t: lapse,
    w: event === SEPARATION ? 0 : value(step.w, length),
    v: value(step.v, length),
    sine: atEnd ? Math.sin(BEGIN_OF_CYCLE) : value(sines, length),
    cosine: atEnd ? Math.cos(BEGIN_OF_CYCLE) : value(cosines, length),
  };
  if (![end.w, end.v, lapse].every(Number.isFinite)) throw new GaveUp("not finite");
  feed(run, motion, step, end, feeding);

  const { w, v, sine, cosine } = end;
  const t = atEnd ? c.period : motion.t + lapse;
  Object.assign(motion, { w, v, sine, cosine, t, theta: BEGIN_OF_CYCLE + c.omega * t });
  if (event === SEPARATION && v >= -c.restSpeed && c.gravity + c.aZ * cosine > 0) motion.v = 0;
  else if (event === SEPARATION) leavePlate(run, motion, -v);
  else if (event === FORCE_SIGN) {
    motion.pulled = !motion.pulled;
    run.record({ time: motion.base + t, kind: motion.pulled ? "tension begins" : "tension ends" });
  }
}

/* Follow the motion along the track during a contact step that ends at `end`: pieces of slip in one direction or of
   stick. Without `feeding` there is one piece, and x is not computed. */
function feed(run, motion, step, end, feeding) {
  const { c } = run;
  const { base, t, theta, pulled } = motion;
  const pressing = !(pulled && c.tension === "clip");
  const [mu, grip] = pulled ? [0, 0] : [c.friction, c.staticFriction];
  let here = { s: 0, t: 0, w: motion.w, v: motion.v, sine: motion.sine, cosine: motion.cosine };
  let { x, vx, sigma } = motion;
  let released = !feeding;
  let leave = LEAVE;
  for (;;) {
    const { sine, cosine } = here;
    const piece = {
      ...{ begin: base + t + here.t, base, t, theta, step, here: here.t, sine, cosine, sigma, mu, pressing, x, vx },
      ...normalMotion(c, here),
    };
    run.keep(piece);
    let change = Infinity;
    if (!released && sigma === 0) [change, released] = stickEnd(c, step, here.s);
    else if (!released) change = slipEnd(c, step, here.s, alongTrack(c, sine, cosine).vx - vx, sigma, mu, leave);
    const changed = change < end.s;
    here = changed ? inside(c, step, change, theta) : end;
    const { z, vz } = normalMotion(c, here);
    ({ x, vx } = moved(c, piece, here.t - piece.here, here.sine, here.cosine, z, vz));
    if (!changed) break;
    const track = alongTrack(c, here.sine, here.cosine);
    vx = track.vx; // exactly
    if (sigma === 0) sigma = Math.sign(track.holding) || 1;
    else sigma = directionAtRest(c, track.holding, force(c, here.w, here.v), grip);
    if (sigma === piece.sigma) {
      // No reversal: the slip is zero to rounding here, and differs from zero only later in the step.
      leave *= 2;
    } else {
      leave = LEAVE;
      const kind = piece.sigma === 0 ? "slip" : sigma === 0 ? "stick" : "slip reversal";
      run.record({ time: base + t + here.t, kind });
    }
  }
  if (feeding && c.staticFriction === 0) {
    // Without friction the part does not take over the error of the moment at which the slip vanishes.
    x = motion.x + (motion.vx - 0.5 * c.downhill * end.t) * end.t;
    vx = motion.vx - c.downhill * end.t;
  }
  Object.assign(motion, { x, vx, sigma });
}

/* The place s of a contact step that begins at the phase `theta`. */
function inside(c, step, s, theta) {
  const t = value(step.t, s);
  const phase = theta + c.omega * t;
  return { s, t, w: value(step.w, s), v: value(step.v, s), sine: Math.sin(phase), cosine: Math.cos(phase) };
}

/* Height and velocity normal to the track of a part in contact. */
function normalMotion(c, { w, v, sine, cosine }) {
  return { z: -c.height * cosine - w * w, vz: c.speedZ * sine - v };
}
