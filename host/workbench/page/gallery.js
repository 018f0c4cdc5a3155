// The catalogue: symptoms of each effect, similar effects, how to separate them, and the remedy.
import { choice } from "./choice.js";
import { el } from "./elements.js";
import { effects } from "./catalogue.js";
import { add } from "./effects.js";
import { get } from "./exchange.js";
import { forgetPlots, showPlot } from "./report_parts.js";

const kStages = { command: "Command and current loop", motor: "Motor", load: "Torques on the shaft", friction: "Friction", mechanics: "Masses and their connections", encoder: "Encoder", tachometer: "Tachometer", table: "Table, as a scale of its own sees it" };

/** Draws the residual of the effect in a standard run when its entry is opened.
 * @param {HTMLDetailsElement} box
 * @param {any} info
 */
async function drawPicture(box, info) {
  const frame = el("div"), figure = el("figure", { className: "plot picture" }, el("p", { className: "soft" }, "Simulating it…"));
  box.querySelector("summary").after(figure);
  try {
    const told = await get("/api/effects/" + info.kind + "/picture");
    figure.replaceChildren(el("figcaption", {}, el("strong", {}, told.title), el("span", {}, told.caption)), frame);
    if (figure.isConnected) showPlot(frame, told.plot);
  } catch (error) {
    figure.replaceChildren(el("p", { className: "soft" }, error.message));
  }
}

function entry(info, catalogue) {
  const link = (kind) => el("a", { href: "#gallery/" + kind }, catalogue.find((one) => one.kind === kind)?.title || kind);
  const term = (name, ...what) => [el("dt", {}, name), el("dd", {}, ...what)];
  const confused = info.confused_with.flatMap((kind, k) => (k ? [", ", link(kind)] : [link(kind)]));
  const opened = (event) => event.target.open && !event.target.querySelector(".picture") && drawPicture(event.target, info);
  return el("details", { className: "effect", id: "effect-" + info.kind, ontoggle: opened },
    el("summary", {}, info.title, el("span", { className: "soft" }, " " + info.shows.split(". ")[0] + ".")),
    el("dl", {},
      ...term("How it shows", info.shows), ...term("Goes with", info.along.join(", ").replaceAll("_", " ") || "–"), ...term("Equation", el("code", {}, info.equation)),
      ...term("Origin", info.origin || "–"), ...term("Easily taken for", ...(confused.length ? confused : ["–"])),
      ...term("How to tell them apart", info.separate_by || "–"), ...term("Remedy", info.remedy || "–")),
    info.base || !choice.model ? null : el("button", { type: "button", onclick: () => add(info.kind) }, "Add it to " + choice.model));
}

/**
 * @param {Element} place
 * @param {string} [kind] entry to open
 */
export async function showGallery(place, kind) {
  const catalogue = await effects();
  const groups = Object.entries(kStages).map(([stage, heading]) => el("section", {}, el("h2", {}, heading), ...catalogue.filter((one) => one.stage === stage).map((one) => entry(one, catalogue))));
  const filter = (event) => {
    const words = event.target.value.toLowerCase();
    for (const info of catalogue) document.getElementById("effect-" + info.kind).hidden = !JSON.stringify(info).toLowerCase().includes(words);
    for (const group of groups) group.hidden = !group.querySelector("details:not([hidden])");
  };
  forgetPlots();
  place.replaceChildren(el("div", { className: "row head" }, el("h1", {}, "Gallery"), el("input", { type: "search", placeholder: "Search, e.g. reversal", "aria-label": "Search the effects", oninput: filter })),
    el("p", { className: "lead" }, "Every effect of the plant model; diagnose tests all of them."), el("div", { className: "gallery" }, ...groups));
  const opened = /** @type {HTMLDetailsElement|null} */ (document.getElementById("effect-" + kind));
  if (!opened) return;
  opened.open = true;
  opened.scrollIntoView();
}
