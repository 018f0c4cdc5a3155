// Candidates for the missing effect as cards in the order of their probability; a click adds one.
import { sliders } from "./adjust.js";
import { effects } from "./catalogue.js";
import { choice, chosenRecords, loadFolder, workOn } from "./choice.js";
import { drawComparison, showComparison } from "./compare.js";
import { commandLine, el, errorBox, notice, percent, short } from "./elements.js";
import { fileAddress, post, report } from "./exchange.js";
import { errorBars, errorTable, parameterTable, probabilityBar } from "./figures.js";
import { begin, jobs, whole } from "./jobs.js";
import { firstLook } from "./look.js";
import { save } from "./plot_files.js";
import { forgetPlots, partsOf, showBlocks } from "./report_parts.js";

const kShown = 0.01; // candidates with a smaller probability are collapsed
const documents = new Map(); // of completed jobs, which do not change
let catalogue = [];
let shown = 0;

async function documentOf(job) {
  if (!documents.has(job.id)) documents.set(job.id, (await whole(job)).document || {});
  return documents.get(job.id);
}

function titleOf(kinds) {
  return kinds.map((kind) => catalogue.find((one) => one.kind === kind)?.title || kind).join(" + ");
}

const madeBy = (model) => jobs.find((job) => job.state === "done" && job.model === model && job.request.do !== "identify");

/** The jobs that led to a model, in their order. */
function stepsTo(model) {
  const steps = [];
  for (let job = madeBy(model); job && !steps.includes(job); job = madeBy(job.request.model)) steps.unshift(job);
  return steps;
}

function request(task) {
  return { do: task, model: choice.model, ...chosenRecords(), accept: choice.accepted };
}

const isSame = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const sameRecords = (job) => isSame([job.request.train, job.request.validate], Object.values(chosenRecords()));

/** The latest search with this model and these records. */
function searched() {
  return jobs.find((job) => job.request.do === "diagnose" && job.request.model === choice.model && sameRecords(job));
}

/**
 * @param {string} kind one effect, or several joined by +
 * @param {string} [over] coordinate of a free curve
 */
export function add(kind, over) {
  return begin({ ...request("add"), kind, ...(over ? { over } : {}) });
}

/** After a job has ended: selects the new model. Returns whether the views have been drawn again.
 * @param {any[]} ended
 */
export async function follow(ended) {
  let isDrawn = false;
  for (const job of ended) {
    if (job.state === "failed") notice(job.message);
    if (job.state !== "done" || !job.model || (job.request.do !== "identify" && job.request.model !== choice.model)) continue;
    if ((await documentOf(job)).kept === "given") {
      notice("The addition predicts held-back records worse, so the model is unchanged.");
      continue;
    }
    await loadFolder();
    await workOn(job.model);
    isDrawn = true;
  }
  return isDrawn;
}

function undo() {
  const made = madeBy(choice.model);
  if (!made) return notice("Nothing to undo: this model was not made here.");
  workOn(made.request.model);
}

/** Saves one page with all steps, on validation records if there are any. */
async function saveStory() {
  const records = chosenRecords();
  const told = await post("/api/story", { do: "compare", models: [choice.model], records: records.validate.length ? records.validate : records.train, accept: choice.accepted }).catch((error) => notice(error.message));
  if (told) save("story.html", new Blob([told.report], { type: "text/html" }));
}

async function ladder(place, steps) {
  const rows = [];
  for (const job of steps) {
    const told = await documentOf(job);
    const row = (label, error) => ({ label, train: error.train.combined, validate: error.validate.combined });
    if (!rows.length) rows.push(row(job.request.model, told.error.given));
    if (job.request.do === "add") rows.push(row("+ " + titleOf(job.request.kind.split("+")), told.error.after));
    else if (job.request.do === "adjust") rows.push(row("values set by hand", told.error.after));
    else for (const step of told.ladder.filter((one) => one.added.length)) rows.push(row("+ " + titleOf(step.added), step.error));
  }
  const last = steps.at(-1), told = await documentOf(last);
  place.append(el("div", { className: "row" }, el("h2", {}, "Steps so far"),
    el("button", { type: "button", id: "undo", title: "Key U", onclick: undo }, "Undo: back to " + last.request.model),
    el("button", { type: "button", id: "story", onclick: saveStory }, "Save the story")));
  if (told.kept === "given") place.append(el("p", { className: "lead" }, "The last step predicts the held-back records worse: " + last.model + " holds the unchanged model."));
  const { parameters, added } = await fitted(steps);
  const rotary = "x_mm" in told.error.after.train.channels || "w_rad_s" in told.error.after.train.channels;
  place.append(el("div", { className: "pair" }, el("div", {}, errorBars(rows), errorTable(told.error.given, told.error.after)), ...(parameters.length ? [el("div", {}, parameterTable(parameters, catalogue, rotary))] : [])));
  place.append(commandLine(last.command));
  return (show, restore) => {
    if (added.length && told.kept !== "given") place.append(sliders(added, catalogue, rotary, show, restore));
  };
}

/** The parameters of the last fit, with values set by hand since then, and those of the added effect. */
async function fitted(steps) {
  let parameters = [], added = [];
  for (const job of steps) {
    const told = await documentOf(job);
    if (told.parameters) parameters = told.parameters;
    const set = Object.fromEntries((job.request.values || []).map((text) => text.split("=")));
    parameters = parameters.map((one) => (one.name in set ? { ...one, value: Number(set[one.name]), determined: false } : one));
    if (job.request.do === "add") added = [...added, ...job.request.kind.split("+")];
  }
  return { parameters, added: parameters.filter((one) => added.includes(one.name.split(".")[0])) };
}

function card(candidate, told) {
  const info = catalogue.find((one) => one.kind === candidate.kinds.at(-1));
  const found = told.verdict.effects.includes(candidate.kinds[0]) && candidate.kinds.every((kind) => told.verdict.effects.includes(kind));
  return el("li", { className: found ? "card found" : "card", "data-kinds": candidate.kinds.join(" ") },
    el("h3", {}, titleOf(candidate.kinds)), probabilityBar(candidate.probability),
    el("p", { className: "soft" }, "Held-back error " + short(candidate.before) + " → " + short(candidate.after) + " × noise floor" + (candidate.luck < 1 ? "; by chance with p = " + short(candidate.luck) : "")),
    el("p", {}, info ? info.shows.split(". ")[0] + "." : ""),
    candidate.confused_with.length ? el("p", { className: "soft" }, "Easily taken for: " + candidate.confused_with.map((kind) => titleOf([kind])).join(", ")) : null,
    el("div", { className: "row" }, el("button", { type: "button", className: "primary", onclick: () => add(candidate.kinds.join("+")) }, "Add it"), el("a", { href: "#gallery/" + candidate.kinds.at(-1) }, "About it")));
}

function plainCard(title, share, text, action = null) {
  return el("li", { className: "card plain" }, el("h3", {}, title), probabilityBar(share), el("p", {}, text), action);
}

/** Effects that these records cannot separate, with the run that would separate them. */
function rivals(group, told) {
  const advice = [...new Set(group.map((kind) => told.candidates.find((one) => one.kinds.at(-1) === kind)?.separate_by).filter(Boolean))];
  const quoted = (name) => (/^[\w./+-]+$/.test(name) ? name : "'" + name.replaceAll("'", "'\\''") + "'");
  return el("section", { className: "rivals" }, el("h3", {}, "These records cannot tell apart: " + group.map((kind) => titleOf([kind])).join(", ")),
    ...advice.map((text) => el("p", {}, text + ".")), el("p", {}, "On a board, this command designs the run that decides, within a box that you give (--box):"),
    commandLine(["axistool plan", quoted(choice.model), "--train", ...chosenRecords().train.map(quoted), "--rivals", group.join(","), "-o run.toml"].join(" ")));
}

function cards(told) {
  const verdict = told.verdict, tied = [verdict.effects, ...verdict.alternatives].flat();
  const useful = told.candidates.filter((one) => one.probability >= kShown || one.kinds.every((kind) => tied.includes(kind)));
  const rest = told.candidates.filter((one) => !useful.includes(one));
  const list = useful.sort((a, b) => b.probability - a.probability).map((one) => card(one, told));
  if (verdict.probability_other > 0) list.push(plainCard("Something else", verdict.probability_other,
    (verdict.coordinate ? "Most of the residual depends on " + verdict.coordinate.replaceAll("_", " ") + (verdict.where ? ", " + verdict.where : "") + ". " : "") + (verdict.effects.length ? "" : "Next: " + verdict.next_experiment),
    el("div", { className: "row" }, el("button", { type: "button", onclick: () => add("free_curve") }, "Add a free curve"))));
  if (verdict.probability_nothing > 0) list.push(plainCard("Nothing is missing", verdict.probability_nothing, "Then the residual would be noise."));
  const places = [el("h2", {}, "Possible explanations"), el("ol", { className: "cards", id: "cards" }, ...list)];
  for (const group of verdict.alternatives) places.push(rivals(group, told));
  if (rest.length) places.push(el("details", {}, el("summary", {}, rest.length + " other tried effects are improbable"), el("ol", { className: "cards" }, ...rest.map((one) => card(one, told)))));
  return places;
}

/** The first panel, then the cards, then the rest of the report. */
async function diagnosis(place, job) {
  const [told, html] = await Promise.all([documentOf(job), report(job.report)]);
  return explained(place, told, html, job.command, el("p", {}, el("a", { href: fileAddress(job.report), target: "_blank", rel: "noopener" }, "Open the whole report")));
}

function explained(place, told, html, command, link) {
  const parts = partsOf(html);
  const second = parts.blocks.filter((block) => block.tagName === "H2")[1];
  const isFirst = (block) => block !== second && !(second && second.compareDocumentPosition(block) & Node.DOCUMENT_POSITION_FOLLOWING);
  return () => {
    place.append(parts.verdict ? document.importNode(parts.verdict, true) : "");
    showBlocks(place, parts, isFirst);
    place.append(...cards(told), commandLine(command), link);
    const more = el("details", {}, el("summary", {}, "Errors, residuals and traces"));
    more.addEventListener("toggle", () => more.children.length === 1 && showBlocks(more, parts, (block) => !isFirst(block)), { once: true });
    place.append(more);
  };
}

function head() {
  const ready = choice.model && chosenRecords().train.length;
  const records = chosenRecords();
  return [el("div", { className: "row head" }, el("h1", {}, "Effects"),
    el("button", { type: "button", className: "primary", id: "diagnose", title: "Key D", disabled: !ready, onclick: () => begin(request("diagnose")) }, "Find the missing effect"),
    el("button", { type: "button", disabled: !ready, onclick: () => begin(request("improve")) }, "Add all significant effects")),
  el("p", { className: "lead" }, ready ? choice.model + ", trained on " + records.train.join(", ") + (records.validate.length ? ", judged on " + records.validate.join(", ") : ", validated on held-back blocks of them") + "."
    : "Choose a model and at least one training record.")];
}

/** Calls it once the page is on the screen: the program's computing takes all processors.
 * @param {() => void} work
 */
const afterPainting = (work) => requestAnimationFrame(() => setTimeout(work));

/** Shows what the force balance alone says, if it says anything.
 * @param {Element} found
 * @param {any} asked the search that is under way, if any
 */
async function look(found, asked) {
  const told = await firstLook();
  if (!told) return found.remove();
  if (!found.isConnected) return;
  found.replaceChildren(el("p", { className: "lead" }, asked ? "First look, by the force balance alone; the search by motion is under way." : "First look, by the force balance alone. “Find the missing effect” searches the motion too."));
  explained(found, told.document, told.report, told.command, "")();
}

/**
 * @param {Element} place
 * @param {string} [wish] "find": starts the search unless there is a result
 */
export async function showEffects(place, wish) {
  const mine = ++shown;
  if (wish === "find") history.replaceState(null, "", "#effects");
  catalogue = await effects();
  const isFind = wish === "find" && !searched() && choice.model && chosenRecords().train.length;
  const body = el("div"), steps = stepsTo(choice.model), draw = [];
  try {
    if (steps.length) {
      const drag = await ladder(body, steps);
      const before = steps.at(-1).request.model, records = chosenRecords();
      const overlay = el("div", { id: "overlay" });
      const { told, show } = await showComparison(overlay, [before, choice.model], records.validate.length ? records.validate : records.train);
      drag((trial) => drawComparison(overlay, trial), () => drawComparison(overlay, told));
      body.append(el("h2", {}, "Before and after, on " + (records.validate.length ? "held-back" : "training") + " records"), overlay);
      draw.push(show);
    }
    const asked = searched();
    if (asked?.state === "done") {
      const found = el("div", { id: "diagnosis" });
      body.prepend(found);
      if (steps.length) body.append(found);
      draw.push(await diagnosis(found, asked));
    } else if (asked?.state !== "failed") {
      const found = el("div", { id: "diagnosis", className: "first-look" }, el("p", { className: "lead" }, "Looking at the force balance…"));
      body.append(found);
      draw.push(() => afterPainting(() => look(found, asked).finally(() => isFind && begin(request("diagnose")))));
    } else
      body.append(errorBox(Object.assign(new Error(asked.message), { log: asked.log }), (words) => (choice.accepted.push(...words), begin(request("diagnose")))));
  } catch (error) {
    body.append(errorBox(error));
  }
  if (mine !== shown || !place.isConnected) return;
  forgetPlots();
  place.replaceChildren(...head(), body);
  draw.forEach((show) => show());
}

export const keys = { d: () => document.getElementById("diagnose")?.click(), u: undo };
