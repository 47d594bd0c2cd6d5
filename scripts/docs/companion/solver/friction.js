/* Coulomb friction along the track, without integration: in contact F_c/m = z̈_p + g cos α, and while the slip velocity
   ẋ_s - ẋ_p keeps its sign σ, with the time τ since then,

       ẋ_p = ẋ_p0 + σμ [ż_p - ż_p0 + g cos α τ] - g sin α τ.

   Where the slip velocity reaches zero, the part sticks while |ẍ_s + g sin α| ≤ μ_s F_c/m. */

/* Where, in the rest of a contact step, the slip velocity reaches zero. It is a polynomial, because F_c/m = z̈_p +
   g cos α. `leave` is the part of the step by which a root at `start` is left behind. */
function slipEnd(c, step, start, slip, sigma, mu, leave) {
  const speedX = sigma * c.speedX;
  const fall = mu * c.gravity - sigma * c.downhill;
  for (let n = 0; n <= ORDER; n++) {
    const plateSlip = speedX * (sines[n] * c.cosineShift + cosines[n] * c.sineShift);
    scratch[n] = plateSlip + mu * (step.v[n] - c.speedZ * sines[n]) - fall * step.t[n];
  }
  scratch[0] = 0;
  scratch[0] = sigma * slip - value(scratch, start);
  return firstRoot(scratch, start, step.length, leave);
}

/* Where, in the rest of a contact step, |ẍ_s + g sin α| exceeds μ_s F_c/m, and whether it stays so until the end. */
function stickEnd(c, step, start) {
  let end = Infinity;
  let lasting = false;
  if (c.aX === 0 && c.downhill === 0) return [end, lasting];
  for (const direction of [-1, 1]) {
    expandForce(c, c.staticFriction);
    for (let n = 0; n < ORDER; n++) {
      const plateW = c.aX * (cosinesW[n] * c.cosineShift - sinesW[n] * c.sineShift) + c.downhill * step.w[n];
      scratch[n] += direction * plateW + c.staticFriction * c.restForce * step.w[n];
    }
    const root = firstRoot(scratch, start, step.length, LEAVE);
    if (root < end) {
      for (let n = 0; n < ORDER; n++) scratch[n] = -scratch[n];
      end = root;
      lasting = firstRoot(scratch, root, step.length, LEAVE) === Infinity;
    }
  }
  return [end, lasting];
}

/* Sign of the slip that follows when the slip velocity is zero, or 0 for stick (Filippov's condition). `holding` is
   the friction force per mass that stick takes, `grip` the coefficient of static friction that acts. */
function directionAtRest(c, holding, contactForce, grip) {
  // The slack in the force keeps a part that barely touches from sticking and slipping without end. Where nothing drives
  // a part along the track it stays, also if the contact pulls.
  if ((c.aX === 0 && holding === 0) || (grip > 0 && Math.abs(holding) <= grip * (contactForce + c.restForce))) return 0;
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
