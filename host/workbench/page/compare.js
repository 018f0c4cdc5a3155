// How well the chosen models predict the chosen records, and where they fail.
import { choice, firstSteps, latestCut, recordsAs, replaceRecord, takeBack } from "./choice.js";
import { effects } from "./catalogue.js";
import { commandLine, el, errorBox, notice, percent, short } from "./elements.js";
import { post } from "./exchange.js";
import { compared } from "./jobs.js";
import { firstLook, ranked } from "./look.js";
import { plots, save } from "./plot_files.js";
import { showPicture } from "./record.js";
import { forgetPlots, partsOf, sectionLinks, showBlocks } from "./report_parts.js";

const kCoordinates = ["position", "speed", "acceleration", "current", "time", "travel_since_reversal", "rest"], kPlotCoordinates = ["position", "phase", ...kCoordinates.slice(1), "temperature"], kUsualMap = ["position", "speed"];
const kSets = [["all", "all records"], ["judge", "held back"], ["train", "training"]];
let set = "all";
let asked = 0;
/** Options of the comparison, as those of the command: { traces, stretch, period_mm, map, plot }. */
let focus = {};
/** Whether the plot of chosen axes is to be shown next. */
let toChosen = false;

function recordsOf(name) {
  return name === "all" ? [...recordsAs("train"), ...recordsAs("judge")] : recordsAs(name);
}

function setButtons(again) {
  return el("div", { className: "segments", role: "group", "aria-label": "Records" }, ...kSets.map(([name, text]) =>
    el("button", { type: "button", "aria-pressed": String(name === set), disabled: !recordsOf(name).length, onclick: () => ((set = name), again()) }, text)));
}

/** Shows the comparison of models with records as the blocks of its report.
 * @param {HTMLElement} place
 * @param {string[]} models
 * @param {string[]} records
 * @param {{focus?: any, onZoom?: (...words: any[]) => void, moreTools?: (figure: HTMLElement, plot: any) => HTMLElement[]}} [options]
 */
export async function showComparison(place, models, records, options = {}) {
  const request = { do: "compare", models, records, accept: choice.accepted, ...options.focus };
  const told = longestOf(records) ? await compared(request) : await post("/api/compare", request);
  return { told, show: () => drawComparison(place, told, options.onZoom, options.moreTools) };
}

/** Draws a received comparison. Replaces the previous content only now, so that the page keeps its scroll position.
 * @param {HTMLElement} place
 * @param {any} told
 * @param {(...words: any[]) => void} [onZoom]
 * @param {(figure: HTMLElement, plot: any) => HTMLElement[]} [moreTools]
 */
export function drawComparison(place, told, onZoom, moreTools) {
  place.style.minHeight = place.offsetHeight + "px";
  forgetPlots(place);
  place.replaceChildren();
  if (told.text) return place.append(el("pre", {}, told.text), commandLine(told.command));
  const parts = partsOf(told.report);
  const page = () => save("comparison.html", new Blob([told.report], { type: "text/html" }));
  place.append(parts.verdict ? document.importNode(parts.verdict, true) : "");
  const links = el("div");
  place.append(links);
  const sections = sectionLinks([showBlocks(place, parts, () => true, onZoom, moreTools)]);
  sections.append(el("button", { type: "button", className: "apart", onclick: page }, "Save as a page"));
  links.replaceWith(sections);
  place.append(commandLine(told.command));
  place.style.minHeight = "";
}

const kRankedShown = 4;

/** Shows beside the comparison the most probable answers of the force-balance regression, as soon as they are known. */
async function showFirstLook(head) {
  const [look, catalogue] = await Promise.all([firstLook(), effects()]);
  if (!look || !head.isConnected) return;
  const named = ({ kinds, title, probability }) =>
    (title || kinds.map((kind) => catalogue.find((one) => one.kind === kind)?.title || kind).join(" + ")) + " " + percent(probability);
  const answers = ranked(look.document);
  const shown = answers.filter((one, k) => k === 0 || (k < kRankedShown && one.probability >= 0.01));
  head.append(el("a", { href: "#effects", id: "first-look", className: "soft", title: look.command }, "First look: " + shown.map(named).join(", ")));
}

/** Form for the options: record of the traces, period, time range. */
function focusTools(records, traces, again) {
  const look = (change) => ((focus = { ...focus, ...change }), again());
  const choose = el("select", { "aria-label": "Traces of", onchange: (event) => look({ traces: event.target.value, stretch: undefined }) }, ...records.map((name) => el("option", { value: name, selected: name === traces }, name)));
  const period = el("input", {
    type: "number", min: "0", step: "any", value: focus.period_mm ?? "", placeholder: "model's ripple", "aria-label": "Period in mm",
    onchange: (event) => look({ period_mm: Number(event.target.value) > 0 ? Number(event.target.value) : undefined }),
  });
  const axis = (k, name) => el("select", { "aria-label": name, onchange: (event) => look({ map: (focus.map || kUsualMap).map((one, index) => (index === k ? event.target.value : one)) }) },
    ...kCoordinates.map((one) => el("option", { value: one, selected: (focus.map || kUsualMap)[k] === one }, one.replaceAll("_", " "))));
  const chosen = (k, name, words) => el("select", { "aria-label": name, onchange: (event) => {
    const plot = (focus.plot || ["", "error"]).map((one, index) => (index === k ? event.target.value : one));
    toChosen = true;
    look({ plot: plot[0] ? plot : undefined });
  } }, ...words.map((one) => el("option", { value: one, selected: (focus.plot || ["", "error"])[k] === one }, one.replaceAll("_", " ") || "…")));
  const lit = focus.stretch ? el("button", { type: "button", id: "unlight", onclick: () => look({ stretch: undefined }) }, "Lit: " + focus.stretch.map(short).join(" to ") + " s ✕") : null;
  const whole = latestCut() ? el("button", { type: "button", id: "take-back", onclick: takeBack }, "Take back: " + latestCut()?.name + " as a whole") : null;
  return el("div", { className: "row focus" }, el("label", {}, "Traces of ", choose), el("label", {}, "Fold by ", period, " mm"), el("span", {}, "Map over ", axis(0, "Map across"), " and ", axis(1, "Map up")),
    el("span", {}, "Plot ", chosen(1, "Plotted", ["error", ...kPlotCoordinates]), " against ", chosen(0, "Plotted against", ["", ...kPlotCoordinates])), lit, whole);
}

async function leaveOut(record, stretch) {
  try {
    const told = await post("/api/cut", { record, stretch });
    notice("In its place: " + told.pieces.join(", "));
    focus = { ...focus, traces: undefined, stretch: undefined };
    await replaceRecord(record, told.pieces);
  } catch (error) {
    notice(error.message);
  }
}

/** After a zoom: offers actions for the zoomed range. */
function zoomTools(traces, again) {
  return (plot, canvas, from, to) => {
    const figure = canvas.closest("figure");
    figure.querySelector(".zoomed")?.remove();
    const whole = plot.kind === "time" ? null : plot.series.flatMap((one) => one.x);
    const isReset = whole && from <= Math.min(...whole) && to >= Math.max(...whole);
    /** @type {[string, (() => any)?][]} */
    const actions = [];
    if (plot.kind === "time") {
      const first = plots().unpack(plot.panels[0].x);
      if (from <= first[0] && to >= first.at(-1)) return;
      const stretch = [from, to].map((value) => Number(value.toPrecision(6)));
      actions.push([short(from) + " to " + short(to) + " s of " + traces], ["Highlight it in all plots", () => ((focus = { ...focus, traces, stretch }), again())], ["Leave it out", () => leaveOut(traces, stretch)]);
    } else if (plot.xLabel === "position [mm]" && !isReset) {
      const period = Number((to - from).toPrecision(4));
      actions.push(["A period of " + period + " mm?"], ["Fold by it", () => ((focus = { ...focus, period_mm: period }), again())]);
    }
    if (actions.length) figure.append(el("div", { className: "row zoomed" }, ...actions.map(([text, onclick]) => (onclick ? el("button", { type: "button", onclick }, text) : el("span", {}, text)))));
  };
}

/** Coordinates by the labels of their axes. */
const kLabels = { "position": "position", "position in the period": "phase", "speed": "speed", "acceleration": "acceleration", "command": "current", "time since start": "time", "travel since the reversal": "travel_since_reversal", "rest before the motion": "rest", "temperature": "temperature" };

/** A button on residual plots: the effects whose own part has that shape. */
function likeTools(records) {
  return (figure, plot) => {
    const over = kLabels[plot.xLabel?.split(" [")[0]];
    if (!over || !plot.label?.startsWith("missing")) return [];
    const ask = async (event) => {
      event.target.disabled = true;
      figure.querySelector(".alike")?.remove();
      try {
        const [told, catalogue] = await Promise.all([post("/api/like", { do: "compare", models: [choice.model], records, accept: choice.accepted, ...focus, like: over }), effects()]);
        const names = told.document.effects.map((one) => el("li", {}, el("a", { href: "#gallery/" + one.kind }, catalogue.find((info) => info.kind === one.kind)?.title || one.kind), " " + one.likeness.toFixed(2)));
        const best = told.document.effects[0]?.likeness || 0;
        figure.append(el("div", { className: "alike" }, el("p", { className: "soft" }, (best < 0.6 ? "No known effect comes close; the nearest" : "This residual has the shape of") + " (correlation with the effect's own part on these records):"), el("ol", {}, ...names), commandLine(told.command)));
      } catch (error) {
        notice(error.message);
      } finally {
        event.target.disabled = false;
      }
    };
    return [el("button", { type: "button", title: "Effects whose own part has this shape", onclick: ask }, "looks like…")];
  };
}

/** Bytes of records whose comparison takes so long that it is a job, and that their channels are shown before it. */
const kLong = 16e6;

/** The longest of the records, if their comparison takes long. */
function longestOf(records) {
  const files = choice.files.filter((file) => records.includes(file.name)).sort((a, b) => b.bytes - a.bytes);
  return files.reduce((sum, file) => sum + file.bytes, 0) > kLong ? files[0].name : null;
}

/** Shows what is told about a comparison, and the channels of the longest record below it.
 * @param {Element} place
 * @param {Element} head
 * @param {Element} told
 * @param {string} record
 */
function showLong(place, head, told, record) {
  if (place.querySelector(".long")?.getAttribute("data-record") === record) return place.querySelector(".long").previousElementSibling.replaceWith(told);
  const box = el("section", { className: "long", "data-record": record });
  place.replaceChildren(head, told, box);
  showPicture(box, record);
}

/** Drops the answer that a comparison still waits for, because another view is shown. */
export function leaveCompare() {
  asked++;
}

/** @param {Element} place */
export async function showCompare(place) {
  const again = () => showCompare(place);
  const mine = ++asked;
  if (!recordsOf(set).length) set = "all";
  const records = recordsOf(set);
  if (!records.includes(focus.traces)) focus = { period_mm: focus.period_mm, map: focus.map, plot: focus.plot };
  const head = el("div", { className: "row head" }, el("h1", {}, "Compare"), setButtons(again));
  if (!choice.model || !records.length) {
    forgetPlots();
    place.replaceChildren(head, choice.model ? el("p", { className: "lead" }, "Choose records on the left, or drop them anywhere.") : firstSteps());
    return;
  }
  const long = longestOf(records);
  if (long) {
    forgetPlots();
    showLong(place, head, el("p", { className: "soft", role: "status" }, "Long records: the comparison is a job, which takes some seconds for each million rows. Below, until then: the channels of the longest."), long);
  } else {
    place.classList.add("waiting");
    if (!place.querySelector(".blocks")) place.replaceChildren(head, el("p", { className: "soft" }, "Predicting…"));
  }
  const body = el("div"), options = { focus, moreTools: likeTools(records) };
  try {
    const { told, show } = await showComparison(body, [choice.model, ...choice.beside], records, options);
    if (mine !== asked || !place.isConnected) return;
    const scrolled = window.scrollY;
    forgetPlots();
    options.onZoom = zoomTools(told.traces, again);
    place.replaceChildren(head, told.traces ? focusTools(records, told.traces, again) : "", body);
    head.append(el("a", { className: "button primary", href: "#effects/find" }, "Find the missing effect"));
    show();
    window.scrollTo(0, scrolled);
    // The plot of chosen axes is the first of its section.
    if (toChosen && focus.plot) [...body.querySelectorAll("h2")].find((one) => one.textContent.startsWith("What is missing"))?.scrollIntoView({ behavior: "smooth" });
    toChosen = false;
    showFirstLook(head).catch((error) => notice(error.message));
  } catch (error) {
    if (mine !== asked) return;
    const told = error.message === "cancelled" ? el("div", { className: "row head", role: "status" }, "The comparison was cancelled.", el("button", { type: "button", onclick: again }, "Compare")) : errorBox(error, (words) => (choice.accepted.push(...words), again()));
    if (long) return showLong(place, head, told, long);
    forgetPlots();
    place.replaceChildren(head, told);
  } finally {
    if (mine === asked) place.classList.remove("waiting");
  }
}
