const MAX_PERIOD = 64;
// A motion is periodic if it returns to this distance in each cycle of one period, in units of the part at rest.
const REPEATED = 1e-6;
// Near a period doubling, convergence is slow and the doubled period appears first: half-periods this close are equal.
const SAME = 1e-4;
// The second state spends most of a cycle in the air; the micro-bounces of the first state are much shorter.
const LONG_FLIGHT = 0.5;

/* The state of motion to which an initial condition converges within a number of excitation cycles. The motion, seen
   once a cycle, must repeat with a period of up to 64 cycles: {state: "first" or "second", period, after}. Otherwise
   the answer is {state: null}, which may be chaos or slow convergence. */
function settle(parameters, cycles, options) {
  // Most motions converge soon.
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
