/* State maps: the state of motion over two parameters, from the project's tables. */

const INITIAL = ["psi0", "z0", "vz0"];
// A state with fewer points than this is hard to see on a map: the legend gives their number.
const FEW = 100;

const mapCanvas = byId("map");
let map = maps[0];
let mapFrame;

function unpackMap(packed) {
  const bytes = Uint8Array.from(atob(packed.states), (letter) => letter.charCodeAt(0));
  const count = packed.x.num * packed.y.num;
  const states = Uint8Array.from({ length: count }, (_, k) => (bytes[k >> 2] >> (2 * (k & 3))) & 3);
  const picture = element("canvas", { width: packed.x.num, height: packed.y.num });
  const image = new ImageData(packed.x.num, packed.y.num);
  const pixels = new DataView(image.data.buffer);
  const palette = data.states.map((state) => parseInt(`${colours[state].slice(1)}ff`, 16));
  states.forEach((state, k) => {
    // The first row of the table is the lowest one, the first row of a picture the highest.
    const row = packed.y.num - 1 - Math.floor(k / packed.x.num);
    pixels.setUint32(4 * (row * packed.x.num + (k % packed.x.num)), palette[state]);
  });
  picture.getContext("2d").putImageData(image, 0, 0);
  return Object.assign(packed, { states, picture });
}

const cell = (axis) => (axis.stop - axis.start) / (axis.num - 1);
/* The chosen value on an axis of a map; phases are reduced to one turn. */
const onAxis = (axis) =>
  axis.name === "psi0" ? ((chosen.psi0 % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI) : Number(chosen[axis.name]);
/* The same, or the least value of the axis for a choice that is no number: a part on the plate. */
const valueOn = (axis) => (Number.isFinite(onAxis(axis)) ? onAxis(axis) : axis.start);
/* Range of an axis that its cells cover: grid points are the centres of their cells. */
const reach = (axis) => [axis.start - 0.5 * cell(axis), axis.stop + 0.5 * cell(axis)];
const within = (axis) => onAxis(axis) >= reach(axis)[0] && onAxis(axis) <= reach(axis)[1];

/* Parameters of a map that differ from the chosen ones. The tangential ones do not act on the state of motion. */
function differences(one) {
  const acting = Object.keys(one.model).filter((name) => !data.tangential.includes(name));
  return acting.filter((name) => !same(chosen[name], one.model[name]));
}

/* State at the grid point nearest to the chosen initial condition, or nothing outside the map. */
function stateOnMap(one) {
  if (!within(one.x) || !within(one.y)) return undefined;
  const [column, row] = [one.x, one.y].map((axis) => Math.round((onAxis(axis) - axis.start) / cell(axis)));
  return data.states[one.states[Math.min(row, one.y.num - 1) * one.x.num + Math.min(column, one.x.num - 1)]];
}

function mapTitle(one) {
  const { acceleration } = one.model;
  const fixed = acceleration === undefined ? "" : `, at ${shownAs("acceleration", acceleration)}`;
  return `${CONTROLS[one.x.name].label} and ${inText(one.y.name)}${fixed}`;
}

/* Choose a point of the map, with the other parameters of the map. */
function moveTo(x, y) {
  const inside = (axis, value) => plain(Math.min(Math.max(value, axis.start), axis.stop));
  const kept = Object.fromEntries(data.tangential.map((name) => [name, chosen[name]]));
  choose({ ...map.model, ...kept, [map.x.name]: inside(map.x, x), [map.y.name]: inside(map.y, y) });
}

/* A cross at the chosen point of the map. */
function drawCross({ context, left, top, width, height, x, y }) {
  if (!within(map.x) || !within(map.y)) return;
  const [xHere, yHere] = [x(onAxis(map.x)), y(onAxis(map.y))];
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.clip();
  for (const [colour, thickness] of [["#ffffff", 4], ["#000000", 1.5]]) {
    context.strokeStyle = colour;
    context.lineWidth = thickness;
    context.beginPath();
    context.arc(xHere, yHere, 4, 0, 2 * Math.PI);
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      context.moveTo(xHere + 4 * dx, yHere + 4 * dy);
      context.lineTo(xHere + 16 * dx, yHere + 16 * dy);
    }
    context.stroke();
  }
  context.restore();
}

function showMap() {
  const other = differences(map);
  const [xControl, yControl] = [CONTROLS[map.x.name], CONTROLS[map.y.name]];
  mapFrame = frame(mapCanvas, reach(map.x), reach(map.y));
  const { context, left, top, width, height } = mapFrame;
  context.imageSmoothingEnabled = false;
  context.globalAlpha = other.length ? 0.3 : 1;
  context.drawImage(map.picture, left, top, width, height);
  context.globalAlpha = 1;
  axes(mapFrame, `${inText(map.x.name)} in ${xControl.unit}`, `${inText(map.y.name)} in ${yControl.unit}`, {
    xFactor: xControl.factor,
    yFactor: yControl.factor,
  });
  drawCross(mapFrame);
  const place = ({ name }) => `${inText(name)} ${shownAs(name, chosen[name])}`;
  const state = stateOnMap(map);
  const subject = other.every((name) => INITIAL.includes(name)) ? "initial condition" : "conveyor";
  const names = other.map((name) => {
    const [ofMap, here] = [map.model, chosen].map((values) => shownAs(name, values[name]));
    return `${inText(name)} ${ofMap} instead of ${here}`;
  });
  byId("map-other").hidden = byId("map-take").hidden = !other.length;
  byId("map-other").textContent = `for another ${subject}`;
  byId("map-here").textContent = other.length
    ? `This map holds for another ${subject}: ${names.join(", ")}. A click or an arrow key chooses the map’s values.`
    : `${place(map.x)}, ${place(map.y)}: ${state ? STATE_NAMES[state].toLowerCase() : "outside the map"}`;
  byId("map-axes").textContent = `${mapTitle(map)}${other.length ? `, for another ${subject}` : ""}`;
}

/* Select the map to show. */
function showOnMap(one) {
  map = one;
  byId("map-choice").value = maps.indexOf(one);
  showMapLegend();
}

function showMapLegend() {
  const count = (state) => map.states.filter((code) => data.states[code] === state).length;
  const occurring = data.states.map((state) => [state, count(state)]).filter(([, points]) => points);
  byId("map-legend").replaceChildren(
    ...occurring.map(([state, points]) => {
      const few = points < FEW ? ` (${points} of ${map.states.length} points)` : "";
      return element("span", {}, swatch(colours[state]), STATE_NAMES[state].toLowerCase() + few);
    }),
  );
}

function clickMap(event) {
  const { left, top, width, height } = mapFrame;
  const box = mapCanvas.getBoundingClientRect();
  const along = (axis, share) => axis.start + Math.round(share * axis.num - 0.5) * cell(axis);
  const x = along(map.x, (event.clientX - box.left - left) / width);
  moveTo(x, along(map.y, 1 - (event.clientY - box.top - top) / height));
}

function steerMap(event) {
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (!steps || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  const cells = event.shiftKey ? 10 : 1;
  moveTo(valueOn(map.x) + steps[0] * cells * cell(map.x), valueOn(map.y) + steps[1] * cells * cell(map.y));
}

