const EPSILON = Number.EPSILON;

/* Gap and its rate after the time `tau` of a flight from z, vz at the phase `theta`. */
function gap(c, z, vz, tau, theta) {
  const phase = theta + c.omega * tau;
  return [
    z + (vz - 0.5 * c.gravity * tau) * tau + c.height * Math.cos(phase),
    vz - c.gravity * tau - c.speedZ * Math.sin(phase),
  ];
}

/* Time in which a part with the given upward velocity falls by a height ≥ 0, without cancellation. */
function timeOfFall(velocity, height, gravity) {
  const root = Math.sqrt(velocity * velocity + 2 * gravity * height);
  return velocity > 0 ? (velocity + root) / gravity : (2 * height) / (root - velocity);
}

// A search for an impact fails after this many steps, or at a gap below zero by more than LOST rounding errors.
const MAX_STEPS = 100000;
const LOST = 1e6;

/* Duration of a flight from the gap q ≥ 0 with its rate, and the approach speed at its end; infinite if there is
   no impact before `limit`. Above the plate's highest point there is no impact. Below it, the parabola of the bound
   q̈ ≥ -(g cos α + a_z) reaches the plate before the part does, so a step to its root misses no impact. */
function nextImpact(c, z, vz, q, rate, theta, limit) {
  const bound = c.gravity + c.aZ;
  let tau = 0;
  if (q <= 4 * EPSILON * (Math.abs(z) + c.height)) {
    // At the plate, that parabola allows no step. The bound a_z ω of the third derivative and the actual q̈ do.
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
    // Rounding error of the longest path so far, up or down.
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
