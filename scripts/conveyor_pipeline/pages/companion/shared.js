/* What all scripts of the page share: the data that comes with the page (see build.py), what is shown now, and how
   numbers are written. Quantities are in SI units except where they are shown. */

const data = JSON.parse(document.getElementById("data").textContent);
const { model, ranges, colours, maps } = data;
const STATE_NAMES = { first: "First state", second: "Second state", chaos: "Chaos", undecided: "Undecided" };

let chosen = { ...model };
let duration = data.solver.duration;
let run; // trajectory of the part
let twin; // trajectory of the second part
let eulerRun;
let resolved; // time until which the trajectory does not depend on the step, see `resolvedUntil`
let stated; // the state that is shown: name and text
let time = 0;

const byId = (id) => document.getElementById(id);

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/* A coloured square, as in legends. */
function swatch(colour = "transparent") {
  const square = element("span", { className: "swatch" });
  square.style.background = colour;
  return square;
}

/* A number without the digits that only binary fractions have. */
const plain = (number) => Number(number.toPrecision(12));
const digits = (number, count) => (number === 0 ? "0" : String(Number(number.toPrecision(count))));
const signed = (text) => text.replaceAll("-", "−");
/* The same number converted to another unit and back may have another last digit. */
const same = (a, b) => a === b || Math.abs(a - b) <= 1e-12 * Math.abs(b);

const raised = (sign) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)];
const power10 = (exponent) => `10${String(exponent).replace(/./g, raised)}`;

/* Smallest and largest of many numbers. */
function bounds(values) {
  return values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
}
