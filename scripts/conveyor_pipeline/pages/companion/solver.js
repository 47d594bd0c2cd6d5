// The motion of a part on a vibrating plate in fixed steps, without the DOM. SI units; parameters have the names of
// scripts/conveyor/parameters.py. z0 may be "conveyor" (Eq. 15), and static_friction null: equal to friction.
const TENSIONS = ["allow", "frictionless", "clip"];
// A step is at most these shares of the excitation cycle, of the inverse angular frequency of the contact in the
// fastest impact, and of the time in which the damping acts. tests/pages/test_companion.py measures the error.
const CYCLE_STEP = 1 / 1000;
const SPRING_STEP = 0.2;
const DAMPING_STEP = 0.1;
// A run with more steps takes too long to follow a slider. One keeps at most about this many states.
const MAX_STEPS = 8e6;
const MAX_STATES = 2.5e5;
// A trajectory has blown up if the part is this far (m) from its initial height.
const FAR = 1;
const COLUMNS = 6; // of `Run.states`: x, vx, z, vz, contact force and friction force per mass

/* The constants of one conveyor that the equations need, with forces per mass. */
function constants(parameters) {
  const { psi0, mass, exponent, friction, tension, inclination, phase_shift: shift } = parameters;
  const omega = 2 * Math.PI * parameters.frequency;
  // cos(π/2) is not zero in floating point.
  const aX = parameters.angle < 0.5 * Math.PI ? parameters.acceleration * Math.cos(parameters.angle) : 0;
  const aZ = parameters.acceleration * Math.sin(parameters.angle);
  return {
    ...{ psi0, mass, exponent, friction, tension, shift, omega, aX, aZ },
    period: 1 / parameters.frequency,
    height: aZ / (omega * omega),
    gravity: parameters.gravity * Math.cos(inclination), // normal to the track
    downhill: parameters.gravity * Math.sin(inclination),
    stiffness: parameters.stiffness / mass,
    damping: parameters.damping / mass,
    staticFriction: parameters.static_friction ?? friction,
  };
}

/* Position and velocity of the plate (Eqs. 3, 4 and 10) at a time, and the friction force per mass that sticking takes. */
function plate(c, time) {
  const theta = c.omega * time + c.psi0;
  const along = Math.cos(theta + c.shift);
  return {
    x: (-c.aX / (c.omega * c.omega)) * along,
    vx: (c.aX / c.omega) * Math.sin(theta + c.shift),
    z: -c.height * Math.cos(theta),
    vz: (c.aZ / c.omega) * Math.sin(theta),
    holding: c.aX * along + c.downhill,
  };
}

const initialHeight = (c, parameters) => (parameters.z0 === "conveyor" ? plate(c, 0).z : parameters.z0);

/* Force of the spring per mass at the gap q. */
function spring(c, q) {
  if (q >= 0) return 0;
  return c.stiffness * (c.exponent === 1.5 ? -q * Math.sqrt(-q) : Math.pow(-q, c.exponent));
}

/* Contact force per mass (Eq. 9) at the gap q and its rate. */
function contactForce(c, q, rate) {
  if (q > 0) return 0;
  const force = spring(c, q) - c.damping * rate;
  return c.tension === "clip" ? Math.max(force, 0) : force;
}

const frictionCoefficient = (c, force) => (force < 0 && c.tension === "frictionless" ? 0 : c.friction);

/* A trajectory: states at even times, and the impacts with their approach speeds and the flights before them. `status`
   is "ok", or the reason why there is no trajectory. */
class Run {
  constructor(c, duration, step) {
    this.c = c;
    this.duration = duration;
    this.steps = Math.ceil(duration / step - 1e-6);
    this.stride = Math.ceil(this.steps / MAX_STATES);
    this.interval = step * this.stride;
    this.impacts = [];
    this.status = this.steps <= MAX_STEPS ? "ok" : `the contact is so stiff that it takes ${this.steps} steps`;
    this.count = this.status === "ok" ? Math.floor(this.steps / this.stride) + 1 : 0;
    this.states = new Float64Array(COLUMNS * this.count);
  }

  /* Position, velocity and forces of the part at a time, and what it does there. */
  at(time) {
    const place = Math.min(Math.max(time / this.interval, 0), this.count - 1);
    const row = Math.min(Math.floor(place), this.count - 2);
    const share = place - row;
    const [x, vx, z, vz, force, friction] = Array.from({ length: COLUMNS }, (_, k) => {
      const value = this.states[COLUMNS * row + k];
      return value + share * (this.states[COLUMNS * (row + 1) + k] - value);
    });
    // The velocity of a part that sticks is that of the plate in each state that is kept.
    const nearest = Math.round(place);
    const slip = plate(this.c, nearest * this.interval).vx - this.states[COLUMNS * nearest + 1];
    let motion = "stick";
    if (this.states[COLUMNS * nearest + 4] === 0) motion = "flight";
    else if (Math.abs(slip) > 1e-9) motion = slip > 0 ? "lags" : "leads";
    const { mass } = this.c;
    return { x, vx, z, vz, contactForce: mass * force, frictionForce: mass * friction, motion };
  }

  /* Mean feeding velocity over the last part of the run (Sect. 3.1). */
  meanVelocity(last) {
    return (this.at(this.duration).x - this.at((1 - last) * this.duration).x) / (last * this.duration);
  }

  lastImpacts(last) {
    return this.impacts.filter(({ time }) => time >= (1 - last) * this.duration);
  }

  /* Largest normal approach speed of the impacts in the last part of the run; 0 if there is none. */
  impactSpeed(last) {
    return this.lastImpacts(last).reduce((largest, { speed }) => Math.max(largest, speed), 0);
  }

  /* Largest contact force in the last part of the run; 0 if there is none. */
  peakForce(last) {
    let largest = this.c.damping * this.impactSpeed(last); // a damper acts from the first moment
    for (let row = Math.ceil(((1 - last) * this.duration) / this.interval); row < this.count; row++) {
      largest = Math.max(largest, this.states[COLUMNS * row + 4]);
    }
    return this.c.mass * largest;
  }
}

/* Steps in a cycle of the excitation, an even number. The fastest impact has the speed that the initial height, the
   initial velocity and the plate can give. */
function stepsPerCycle(c, z, vz) {
  const speed = Math.hypot(vz, Math.sqrt(2 * c.gravity * (Math.abs(z) + c.height))) + (3 * c.aZ) / c.omega;
  const depth = Math.pow((0.5 * (c.exponent + 1) * speed * speed) / c.stiffness, 1 / (c.exponent + 1));
  const frequency = Math.sqrt(c.exponent * c.stiffness * Math.pow(depth, c.exponent - 1));
  const longest = Math.min(CYCLE_STEP * c.period, SPRING_STEP / frequency, DAMPING_STEP / c.damping);
  return 2 * Math.ceil((0.5 * c.period) / longest);
}

/* Follow one part for a `duration`. Across the track, the classical Runge-Kutta method advances the gap q and
   y = q' + (d_c/m) min(q, 0). In these variables nothing jumps at an impact: q' = y - (d_c/m) min(q, 0) and
   y' = -g cos α - a_z cos θ + (k_c/m) max(-q, 0)^p. Along the track, friction transmits at most the impulse of the
   contact force times its coefficient. `coarsening`: factor of the step. */
function follow(parameters, duration, coarsening = 1) {
  const c = constants(parameters);
  const { damping, gravity } = c;
  const clipped = c.tension === "clip";
  const start = initialHeight(c, parameters);
  const perCycle = stepsPerCycle(c, start, parameters.vz0) / coarsening;
  const step = c.period / perCycle;
  const run = new Run(c, duration, step);
  if (run.status !== "ok") return run;

  const plates = Array.from({ length: perCycle }, (_, k) => plate(c, k * step));
  // Weight and inertia per mass at the ends and middles of the steps.
  const loads = Float64Array.from({ length: 2 * perCycle + 1 }, (_, k) => {
    return gravity + c.aZ * Math.cos(c.psi0 + (Math.PI * k) / perCycle);
  });
  const rateOf = (q, y) => (q < 0 ? y - damping * q : y);
  const change = (q, y, load) => {
    if (q >= 0) return -load;
    const push = spring(c, q);
    return (clipped ? Math.max(push, damping * rateOf(q, y)) : push) - load;
  };

  let [x, vx, z, vz] = [0, 0, start, parameters.vz0];
  let q = parameters.z0 === "conveyor" ? 0 : z - plates[0].z;
  let rate = vz - plates[0].vz;
  let y = rate + damping * Math.min(q, 0);
  let takeOff = 0;
  for (let i = 0; i <= run.steps; i++) {
    const k = i % perCycle;
    const here = plates[k];
    const slip = here.vx - vx;
    if (i % run.stride === 0) {
      const force = contactForce(c, q, rate);
      const sticks = slip === 0 && force > 0 && Math.abs(here.holding) <= c.staticFriction * force;
      const friction = sticks ? here.holding : frictionCoefficient(c, force) * force * Math.sign(slip);
      run.states.set([x, vx, z, vz, force, friction], (COLUMNS * i) / run.stride);
    }
    // The motion across the track
    const [load, middle, after] = [loads[2 * k], loads[2 * k + 1], loads[2 * k + 2]];
    const before = q;
    if (clipped && q < 0 && contactForce(c, q, rate) === 0) {
      // The spring yields faster than the part leaves it: only weight and inertia act, as in a flight.
      q += step * (rate - (step / 6) * (load + 2 * middle));
      rate -= (step / 6) * (load + 4 * middle + after);
      y = rate + damping * Math.min(q, 0);
    } else {
      const [q1, y1] = [rateOf(q, y), change(q, y, load)];
      const [qb, yb] = [q + 0.5 * step * q1, y + 0.5 * step * y1];
      const [q2, y2] = [rateOf(qb, yb), change(qb, yb, middle)];
      const [qc, yc] = [q + 0.5 * step * q2, y + 0.5 * step * y2];
      const [q3, y3] = [rateOf(qc, yc), change(qc, yc, middle)];
      const [qd, yd] = [q + step * q3, y + step * y3];
      const [q4, y4] = [rateOf(qd, yd), change(qd, yd, after)];
      q += (step / 6) * (q1 + 2 * q2 + 2 * q3 + q4);
      y += (step / 6) * (y1 + 2 * y2 + 2 * y3 + y4);
      rate = rateOf(q, y);
    }
    const there = plates[(k + 1) % perCycle];
    const impulse = before > 0 && q > 0 ? 0 : rate + there.vz - vz + gravity * step;
    [z, vz] = [q + there.z, rate + there.vz];
    if (before > 0 !== q > 0) {
      const time = (i + before / (before - q)) * step;
      if (q > 0) takeOff = time;
      else run.impacts.push({ time, speed: -rateOf(0, y), flight: time - takeOff });
    }
    // The motion along the track: within a step, the slip changes linearly, and friction may end or reverse it.
    const lag = there.vx - here.vx + c.downhill * step; // by which the slip grows without friction
    const old = vx;
    const rub = frictionCoefficient(c, impulse) * impulse;
    let slipAfter = slip + lag - Math.sign(slip) * rub;
    if (slip * slipAfter <= 0) {
      const remaining = slip === 0 ? 1 : slipAfter / (slipAfter - slip);
      slipAfter = Math.abs(lag) <= c.staticFriction * impulse ? 0 : remaining * (lag - Math.sign(lag) * rub);
    }
    vx = there.vx - slipAfter;
    x += slip === 0 && slipAfter === 0 ? there.x - here.x : 0.5 * step * (old + vx);
  }
  if (!Number.isFinite(z)) run.status = "the trajectory blows up";
  run.impacts = run.impacts.filter(({ time }) => time <= duration);
  return run;
}

/* Time until which a run with longer steps shows the same height and feeding velocity, up to a share of the ranges of
   both over the run. */
function resolvedUntil(run, coarse, share) {
  if (coarse.status !== "ok") return 0;
  const { c } = run;
  const largest = { z: c.height, vx: c.aX / c.omega }; // of the plate
  return Object.keys(largest).reduce((resolved, name) => {
    const column = name === "z" ? 2 : 1;
    let [low, high] = [-largest[name], largest[name]];
    for (let row = 0; row < run.count; row++) {
      const value = run.states[COLUMNS * row + column];
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    for (let row = 0; row < coarse.count; row++) {
      const time = row * coarse.interval;
      if (time >= resolved) return resolved;
      const apart = coarse.states[COLUMNS * row + column] - run.at(time)[name];
      if (!(Math.abs(apart) <= share * (high - low))) return time;
    }
    return resolved;
  }, run.duration);
}

/* The trajectory by the paper's method, explicit Euler with a fixed step (Sect. 3 of the paper). Its friction chatters
   where the part should stick. Only where the static friction exceeds the friction may a part whose slip changes its
   sign take on the velocity of the plate. */
function euler(parameters, duration, step) {
  const c = constants(parameters);
  const run = new Run(c, duration, step);
  let x = 0;
  let vx = 0;
  let lastSlip = plate(c, 0).vx;
  let z = initialHeight(c, parameters);
  let vz = parameters.vz0;
  const start = z;
  for (let i = 0; i <= run.steps; i++) {
    const ground = plate(c, i * step);
    const q = z - ground.z;
    const force = contactForce(c, q, vz - ground.vz);
    let slip = ground.vx - vx;
    let friction = frictionCoefficient(c, force) * force * Math.sign(slip);
    if (c.staticFriction > c.friction && q <= 0 && lastSlip * slip <= 0) {
      if (Math.abs(ground.holding) <= c.staticFriction * force) [vx, slip, friction] = [ground.vx, 0, ground.holding];
    }
    lastSlip = slip;
    if (i % run.stride === 0) {
      if (!(Math.abs(z - start) < FAR)) {
        run.status = "blows up";
        return run;
      }
      run.states.set([x, vx, z, vz, force, friction], (COLUMNS * i) / run.stride);
    }
    x += step * vx;
    vx += step * (friction - c.downhill);
    z += step * vz;
    vz += step * (force - c.gravity);
  }
  return run;
}
