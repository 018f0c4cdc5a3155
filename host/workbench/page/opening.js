// Opens logs of any controller: shows the recognised channels and makes records.
import { giveRoles, isForJudging } from "./choice.js";
import { commandLine, el, notice, percent, short } from "./elements.js";
import { post } from "./exchange.js";

let asked = 0;

/** What a channel can be: words, column of a record, factor to its unit. */
const kQuantities = /** @type {[string, string, number][]} */ ([
  ["time in s", "t_s", 1], ["time in ms", "t_s", 1e-3], ["time in µs", "t_s", 1e-6],
  ["current in A", "i_A", 1], ["current in mA", "i_A", 1e-3], ["command in V", "u_V", 1], ["command in mV", "u_V", 1e-3],
  ["position in mm", "x_mm", 1], ["position in µm", "x_mm", 1e-3], ["position in m", "x_m", 1],
  ["speed in rad/s", "w_rad_s", 1], ["speed in rpm", "w_rad_s", Math.PI / 30], ["speed in mm/s", "v_mm_s", 1], ["speed in m/s", "v_m_s", 1],
  ["set position in mm", "x_ref_mm", 1], ["set position in m", "x_ref_m", 1], ["load's position in mm", "x2_mm", 1], ["temperature in °C", "temp_C", 1],
]);

/** Channels that the user has chosen on this page, by name: place in kQuantities, and a further factor.
 * @type {Map<string, {quantity: number, times: number}>}
 */
const own = new Map();

const isQuotable = (name) => !name.includes('"') || !name.includes("'");

/** The argument of --map, one text for each channel that was chosen. */
function mapped() {
  return [...own].map(([name, { quantity, times }]) => {
    const quote = name.includes('"') ? "'" : '"', [, column, factor] = kQuantities[quantity];
    return column + "=" + quote + name + quote + "*" + factor * times;
  });
}

/**
 * @param {Element} place
 * @param {string[]} logs
 */
export async function showOpening(place, logs) {
  own.clear();
  place.replaceChildren(el("h1", {}, logs.join(", ")), el("p", { className: "soft" }, "Reading…"));
  await open(place, logs, false);
}

/** The fields in which the user says what a channel is, for all logs that have it.
 * @param {any} channel
 * @param {boolean} isFirst in the first of these logs
 * @param {() => void} changed
 */
function choices(channel, isFirst, changed) {
  if (!isFirst || !isQuotable(channel.name)) return [channel.taken_as || "–", channel.taken_as ? short(channel.factor) : ""];
  const times = el("input", { type: "number", step: "any", value: own.get(channel.name)?.times ?? 1, disabled: !own.has(channel.name), className: "factor", "aria-label": "Factor of " + channel.name });
  const select = el("select", { "aria-label": "Quantity of " + channel.name },
    el("option", { value: "" }, channel.taken_as || "–"), ...kQuantities.map(([words], k) => el("option", { value: String(k), selected: own.get(channel.name)?.quantity === k }, words)));
  const take = () => {
    if (select.value === "") own.delete(channel.name);
    else own.set(channel.name, { quantity: Number(select.value), times: Number(times.value) || 1 });
    times.disabled = select.value === "";
    changed();
  };
  select.addEventListener("change", take);
  times.addEventListener("change", take);
  return [select, el("span", {}, channel.taken_as && !own.has(channel.name) ? short(channel.factor) + " " : "", times)];
}

function channels(file, changed, seen) {
  const heads = ["channel", "taken as", "factor", "sure", "why"].map((text) => el("th", { scope: "col" }, text));
  const rows = file.channels.map((channel) => {
    const [quantity, factor] = choices(channel, !seen.has(channel.name), changed);
    seen.add(channel.name);
    return el("tr", {}, el("td", {}, channel.name), el("td", {}, quantity), el("td", { className: "number" }, factor), el("td", { className: "number" }, percent(channel.sure)), el("td", {}, channel.why));
  });
  return el("figure", { className: "table" },
    el("figcaption", {}, el("strong", {}, file.file), el("span", {}, file.layout + (file.rate_Hz > 0 ? ", " + short(file.rate_Hz) + " Hz" : ""))),
    el("div", { className: "scroll" }, el("table", {}, el("thead", {}, el("tr", {}, ...heads)), el("tbody", {}, ...rows))),
    ...file.missing.map((text) => el("p", {}, "Missing: " + text)), file.next ? el("p", {}, "Next: " + file.next) : "");
}

async function open(place, logs, yes) {
  const mine = ++asked;
  const { document: told, command } = await post("/api/open", { logs, yes, map: mapped() });
  if (told.records.length) {
    notice("In the folder: " + told.records.join(", "));
    await giveRoles(Object.fromEntries(told.records.map((record) => [record, isForJudging(record) ? "judge" : "train"])));
    location.hash = "#compare";
    return;
  }
  if (mine !== asked) return;
  const accept = () => open(place, logs, true).catch((error) => notice(error.message));
  const remake = el("button", { type: "button", className: "primary", id: "choose-channels", hidden: true, onclick: accept }, "Make records with these channels");
  const changed = () => (remake.hidden = !own.size), seen = new Set();
  changed();
  place.replaceChildren(
    el("h1", {}, logs.join(", ")),
    el("p", { className: "lead" }, told.asks.length ? "Is this right?" : "No record can be made from this yet: see below what is missing, or say what the channels are."),
    ...told.asks.map((ask) => el("p", {}, ask)),
    told.asks.length ? el("button", { type: "button", className: "primary", id: "accept-opening", onclick: accept }, "Correct: make records") : "",
    remake, commandLine(command), ...told.files.map((file) => channels(file, changed, seen)));
}
