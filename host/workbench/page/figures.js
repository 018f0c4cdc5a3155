// Errors before and after, as bars and as a table in physical units.
import { el, percent, short } from "./elements.js";

/** Channel name, factor and unit for the user.
 * @param {string} name
 */
function shown(name) {
  const known = { x_mm: ["position", 1e3, "µm"], x_m: ["position", 1e6, "µm"], w_rad_s: ["speed", 1, "rad/s"], v_m_s: ["speed", 1e3, "mm/s"] };
  return known[name] || [name, 1, ""];
}

function change(before, after) {
  const part = after / before - 1;
  return (part > 0 ? "+" : "−") + Math.round(100 * Math.abs(part)) + " %";
}

/** Combined errors of steps relative to the noise floor, for training and validation.
 * @param {{label: string, train: number, validate: number}[]} steps
 */
export function errorBars(steps) {
  const longest = Math.max(1, ...steps.flatMap((step) => [step.train, step.validate]).filter(isFinite));
  const bar = (name, value, colour) => el("div", { className: "bar" },
    el("span", { className: "track" }, el("i", { style: "width:" + (100 * value) / longest + "%;background:var(--" + colour + ")" }), el("i", { className: "reference", style: "left:" + 100 / longest + "%" })),
    el("span", { className: "value", title: name }, short(value) + " ×"));
  const rows = steps.map((step) => el("tr", {}, el("th", { scope: "row" }, step.label), el("td", {}, bar("training", step.train, "train"), bar("held back", step.validate, "model"))));
  const swatch = (colour, text) => el("span", {}, el("i", { className: "swatch", style: "background:var(--" + colour + ")" }), text);
  return el("figure", { className: "bars" },
    el("figcaption", {}, el("strong", {}, "Error in multiples of the noise floor"), el("span", {}, "All channels together; a perfect model gives 1.")),
    el("div", { className: "legend" }, swatch("train", "training"), swatch("model", "held back"), el("span", {}, el("i", { className: "swatch line" }), "noise floor")),
    el("table", {}, ...rows));
}

/**
 * A table that becomes blocks on a narrow screen.
 * @param {string} title
 * @param {string} caption
 * @param {string[]} heads
 * @param {string[][]} rows
 * @param {number} numbers first column that is aligned right
 */
function table(title, caption, heads, rows, numbers) {
  const cell = (text, k) => el("td", { className: k >= numbers ? "number" : "", "data-heading": heads[k] }, text);
  return el("figure", { className: "table stacks" }, el("figcaption", {}, el("strong", {}, title), el("span", {}, caption)),
    el("div", { className: "scroll" }, el("table", {}, el("thead", {}, el("tr", {}, ...heads.map((text, k) => el("th", { scope: "col", className: k >= numbers ? "number" : "" }, text)))),
      el("tbody", {}, ...rows.map((row) => el("tr", {}, ...row.map(cell)))))));
}

/** Errors of every channel, before and after.
 * @param {any} given
 * @param {any} after each { train, validate } of figures
 */
export function errorTable(given, after) {
  const rows = [];
  for (const [set, title] of [["train", "training"], ["validate", "held back"]])
    for (const [name, channel] of Object.entries(after[set]?.channels || {})) {
      const before = given[set]?.channels?.[name];
      const [quantity, factor, unit] = shown(name);
      const value = (figures) => short(factor * figures.rms) + " " + unit + (figures.share === null || figures.share === undefined ? "" : " (" + short(100 * figures.share) + " %)");
      rows.push([title, quantity, before ? value(before) : "–", value(channel), before ? change(before.rms, channel.rms) : "", short(factor * channel.floor) + " " + unit]);
    }
  return table("Error in units of the machine", "RMS, and share of the signal.", ["records", "channel", "before", "after", "change", "noise floor"], rows, 2);
}

/** The key of a parameter such as "cogging.cosine" in the model file, which includes its unit.
 * @param {string} name
 * @param {any[]} catalogue
 * @param {boolean} rotary
 */
export function keyOf(name, catalogue, rotary) {
  const [kind, id] = name.split(".");
  const number = /_\d+$/.exec(id)?.[0] || "";
  const parameters = catalogue.find((one) => one.kind === kind)?.parameters || [];
  const known = parameters.find((one) => one.id === id) || parameters.find((one) => one.id + number === id);
  return kind.replaceAll("_", " ") + ": " + (known ? (rotary ? known.rotary_key : known.linear_key) + (known.id === id ? "" : number) : id);
}

/** Table of the fitted parameters.
 * @param {any[]} parameters of axis-addition/1
 * @param {any[]} catalogue
 * @param {boolean} rotary
 */
export function parameterTable(parameters, catalogue, rotary) {
  const k95 = 1.96;
  const rows = parameters.map((one) => [keyOf(one.name, catalogue, rotary), String(Number(one.value.toPrecision(5))), one.determined ? "± " + short(k95 * one.deviation) : "not determined"]);
  return table("Parameters, all refitted", "", ["parameter", "value", "95 %"], rows, 1);
}

/** @param {number} share 0 to 1 */
export function probabilityBar(share) {
  return el("div", { className: "bar" }, el("span", { className: "track" }, el("i", { style: "width:" + 100 * share + "%;background:var(--model)" })), el("span", { className: "value" }, percent(share)));
}
