/* The part on the plate from the side. The track rises by the inclination; the view follows the part. */

/* Both axes have one scale. A point (x, z) of the track is turned by the inclination to where it is seen. */
function drawScene() {
  const canvas = byId("scene");
  const [low, high] = extent.height;
  const radius = 0.09 * (high - low);
  const margin = 0.3 * (high - low);
  const span = high + 2 * radius - low + margin;
  const width =
    (span * (canvas.clientWidth - MARGIN.left - MARGIN.right)) / (canvas.clientHeight - MARGIN.top - MARGIN.bottom);
  const { period } = run.c;
  const xAt = (one) => run.at(Math.min(Math.max(one, 0), duration)).x;
  const centre = 0.5 * (xAt(time - 0.5 * period) + xAt(time + 0.5 * period));

  const [sine, cosine] = [Math.sin(chosen.inclination), Math.cos(chosen.inclination)];
  const turned = (x, z) => [x * cosine - z * sine, x * sine + z * cosine];
  const [across, up] = turned(centre, 0);
  const heights = [up + low - margin, up + high + 2 * radius];
  const shape = frame(canvas, [across - 0.5 * width, across + 0.5 * width], heights);
  const { context } = shape;
  const path = (points, closed = false) => {
    context.beginPath();
    for (const [x, z] of points) {
      const [right, above] = turned(x, z);
      context.lineTo(shape.x(right), shape.y(above));
    }
    if (closed) context.closePath();
  };
  const circle = (x, z, size) => {
    const [right, above] = turned(x, z);
    context.beginPath();
    context.arc(shape.x(right), shape.y(above), size, 0, 2 * Math.PI);
  };
  const pixels = shape.y(0) - shape.y(radius);
  const ground = solver.plate(run.c, time);
  const look = looks();
  context.save();
  context.beginPath();
  context.rect(shape.left, shape.top, shape.width, shape.height);
  context.clip();

  // The plate, with marks that move with it.
  const [from, to] = [centre - width, centre + width];
  context.fillStyle = style("plate");
  path([[from, ground.z], [to, ground.z], [to, ground.z - width], [from, ground.z - width]], true);
  context.fill();
  context.strokeStyle = style("paper");
  context.lineWidth = 2;
  const every = ticks(0, width, 8);
  const spacing = every[1] - every[0];
  for (let k = Math.floor((from - ground.x) / spacing); k * spacing + ground.x < to; k++) {
    const x = k * spacing + ground.x;
    path([[x, ground.z - 0.1 * margin], [x, ground.z - 0.6 * margin]]);
    context.stroke();
  }

  // The path of one point of the plate, a line or an ellipse, within the view; and its present position.
  const beside = centre + Math.max(0, Math.min(0.25 * width, 0.46 * width - run.c.aX / run.c.omega ** 2));
  const cycle = Array.from({ length: 73 }, (_, k) => solver.plate(run.c, (k * period) / 72));
  context.strokeStyle = context.fillStyle = style("ink");
  context.lineWidth = 1.5;
  path(cycle.map(({ x, z }) => [beside + x, z]));
  context.stroke();
  circle(beside + ground.x, ground.z, 4);
  context.fill();

  // The path of the part over the last two cycles, then both parts: each touches the plate with its lowest point.
  context.strokeStyle = look.part.colour;
  context.lineWidth = 1;
  path(moments(Math.max(0, time - 2 * period), time, 160).map((one) => [run.at(one).x, run.at(one).z]));
  context.stroke();
  const ball = (part, fill) => {
    circle(part.x, part.z + radius, pixels);
    context.fillStyle = fill;
    context.fill();
    context.strokeStyle = style("ink");
    context.lineWidth = 2;
    context.setLineDash(fill === "transparent" ? [4, 3] : []);
    context.stroke();
    context.setLineDash([]);
  };
  ball(run.at(time), look.part.colour);
  if (twin) ball(twin.at(time), "transparent");
  context.restore();
  const labels = sine ? ["horizontal position", "vertical position"] : ["position x", "height z"];
  axes(shape, ...labels.map((label) => `${label} in mm`), { xFactor: 1e3, yFactor: 1e3 });
}

/* The scene in words. */
function describeScene() {
  const { aX, aZ, shift } = run.c;
  const drive = aX && aZ && Math.abs(Math.sin(shift)) > 1e-6 ? "along an ellipse" : "along a straight line";
  const { inclination } = chosen;
  const track = inclination ? `a track inclined by ${shownAs("inclination", inclination)}` : "a level track";
  byId("scene").setAttribute("aria-label", `The part on ${track}; the plate moves ${drive}.`);
}
