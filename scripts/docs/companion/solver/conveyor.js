const TENSIONS = ["allow", "frictionless", "clip"];

/* The constants of one conveyor that the equations need, with forces per mass. */
function constants(parameters, tolerance) {
  const omega = 2 * Math.PI * parameters.frequency;
  // cos(π/2) is not zero in floating point.
  const aX = parameters.angle < 0.5 * Math.PI ? parameters.acceleration * Math.cos(parameters.angle) : 0;
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
    // Below this w the force of a spring of any other power is negligible, and `expand` leaves it out.
    edgeW: exponent === 1.5 || exponent === 1 ? 0 : Math.pow((tolerance * gravity) / stiffness, 0.5 / exponent),
    // At this tolerance, slower impacts and separations count as rest, and weaker contact forces as zero.
    restSpeed: 10 * tolerance * scaleV,
    restForce: 10 * tolerance * gravity,
  };
}

/* Motion of the plate along the track at a phase θ that is given by its sine and cosine: position x = -(a_x/ω²)
   cos(θ + ε), velocity vx, and the friction force per mass ẍ_s + g sin α that sticking takes. */
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
