/* The trajectory by the paper's method, explicit Euler with a fixed step (Sect. 3 of the paper). It steps over
   impacts, and its friction chatters where the part should stick. Only where the static friction exceeds the friction
   may a part whose slip changes its sign take on the velocity of the plate. It keeps every `stride`th step. */
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

// A trajectory has blown up if the part is this far (m) from its initial height.
const FAR = 1;

function euler(parameters, duration, step, stride) {
  const c = constants(parameters, 0);
  const steps = Math.max(1, Math.round(duration / step));
  const states = new Float64Array(6 * (Math.floor(steps / stride) + 1));
  const run = new EulerRun(duration, step, stride, states);
  let x = 0;
  let vx = 0;
  let lastSlip = alongTrack(c, Math.sin(c.psi0), Math.cos(c.psi0)).vx;
  let z = parameters.z0 === "conveyor" ? -c.height * Math.cos(c.psi0) : parameters.z0;
  let vz = parameters.vz0;
  const start = z;
  for (let i = 0; i <= steps; i++) {
    const phase = c.omega * (i * step) + c.psi0;
    const [sine, cosine] = [Math.sin(phase), Math.cos(phase)];
    const q = z + c.height * cosine;
    let push = 0;
    if (q <= 0) push = force(c, Math.sqrt(-q), c.speedZ * sine - vz);
    if (push < 0 && c.tension === "clip") push = 0;
    const mu = push < 0 && c.tension === "frictionless" ? 0 : c.friction;
    const track = alongTrack(c, sine, cosine);
    let slip = track.vx - vx;
    let rub = mu * push * Math.sign(slip);
    if (c.staticFriction > c.friction && q <= 0 && lastSlip * slip <= 0) {
      if (Math.abs(track.holding) <= c.staticFriction * push) [vx, slip, rub] = [track.vx, 0, track.holding];
    }
    lastSlip = slip;
    if (i % stride === 0) {
      if (!(Math.abs(z - start) < FAR)) {
        run.status = "blows up";
        return run;
      }
      states.set([x, vx, z, vz, c.mass * push, c.mass * rub], 6 * (i / stride));
    }
    x += step * vx;
    vx += step * (rub - c.downhill);
    z += step * vz;
    vz += step * (push - c.gravity);
  }
  return run;
}
