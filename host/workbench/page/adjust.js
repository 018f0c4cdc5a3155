// Sliders for the values of an effect: every view follows the drag; afterwards the values can be kept or undone.
import { choice, chosenRecords } from "./choice.js";
import { el, notice, short } from "./elements.js";
import { post } from "./exchange.js";
import { keyOf } from "./figures.js";
import { begin } from "./jobs.js";

const kSteps = 200;

/** Range of a slider: the value's own size to either side, but at least some of its standard deviations.
 * @param {{value: number, deviation: number, determined: boolean}} one
 * @param {{lower: number, upper: number}|undefined} bounds
 */
export function rangeOf(one, bounds) {
  const reach = Math.max(Math.abs(one.value), one.determined ? 5 * one.deviation : 0) || 1;
  return [Math.max(bounds?.lower ?? -Infinity, one.value - reach), Math.min(bounds?.upper ?? Infinity, one.value + reach)];
}

/**
 * @param {any[]} parameters of axis-addition/1 that can be dragged
 * @param {any[]} catalogue
 * @param {boolean} rotary
 * @param {(told: any) => void} show draws a received comparison
 * @param {() => void} restore draws the previous comparison
 */
export function sliders(parameters, catalogue, rotary, show, restore) {
  const values = new Map(), undone = []; // changed values, and the states before each change
  let isAsking = false, isStale = false, turn = 0;
  const request = () => ({ do: "adjust", model: choice.model, ...chosenRecords(), accept: choice.accepted, values: [...values].map(([name, value]) => name + "=" + value) });
  async function ask() {
    if (isAsking) return void (isStale = true);
    isAsking = true;
    const mine = turn;
    try {
      const told = await post("/api/trial", request());
      if (mine === turn) show(told);
    } catch (error) {
      notice(error.message);
    }
    isAsking = false;
    if (!isStale) return;
    isStale = false;
    if (values.size) ask();
  }
  const rows = parameters.map((one) => {
    const [kind, id] = one.name.split("."), known = catalogue.find((effect) => effect.kind === kind)?.parameters || [];
    const bounds = known.find((parameter) => parameter.id === id.replace(/_\d+$/, "")) || known.find((parameter) => parameter.id === id);
    const [low, high] = rangeOf(one, bounds), name = keyOf(one.name, catalogue, rotary);
    const reading = el("output", {}, short(one.value));
    const input = el("input", { type: "range", min: "0", max: String(kSteps), step: "1", value: String(Math.round((kSteps * (one.value - low)) / (high - low))), "aria-label": name, "data-name": one.name });
    const atHand = () => Number((low + ((high - low) * Number(input.value)) / kSteps).toPrecision(6));
    const first = input.value;
    const set = () => {
      reading.textContent = short(input.value === first ? one.value : atHand());
      input.setAttribute("aria-valuetext", reading.textContent);
    };
    input.addEventListener("input", () => {
      if (!undone.length || undone.at(-1).open !== input) undone.push({ open: input, values: new Map(values) });
      if (input.value === first) values.delete(one.name);
      else values.set(one.name, atHand());
      set();
      changed();
    });
    input.addEventListener("change", () => undone.length && (undone.at(-1).open = null));
    const place = (value) => {
      input.value = value === undefined ? first : String(Math.round((kSteps * (value - low)) / (high - low)));
      set();
    };
    set();
    return { name: one.name, place, row: el("label", { className: "slider" }, el("span", {}, name), input, reading) };
  });
  const keep = el("button", { type: "button", className: "primary", id: "keep-values", disabled: true, onclick: () => begin(request()) }, "Keep these values");
  const back = el("button", { type: "button", id: "undo-values", disabled: true, onclick: () => {
    const before = undone.pop();
    if (!before) return;
    values.clear();
    for (const [name, value] of before.values) values.set(name, value);
    rows.forEach((one) => one.place(values.get(one.name)));
    changed();
  } }, "Undo the drag");
  function changed() {
    keep.disabled = !values.size;
    back.disabled = !undone.length;
    if (values.size) return ask();
    ++turn;
    restore();
  }
  return el("figure", { className: "sliders" }, el("figcaption", {}, el("strong", {}, "Drag a value"), el("span", {}, "All views follow. Nothing is fitted, and nothing is written until you keep it.")),
    ...rows.map((one) => one.row), el("div", { className: "row" }, keep, back));
}
