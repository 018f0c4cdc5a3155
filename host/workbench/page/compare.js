// How well the chosen models predict the chosen records, and where they fail.
import { choice, recordsAs } from "./choice.js";
import { commandLine, el, errorBox } from "./elements.js";
import { post } from "./exchange.js";
import { forgetPlots, partsOf, sectionLinks, showBlocks } from "./report_parts.js";

const kSets = [["all", "all records"], ["judge", "held back"], ["train", "training"]];
let set = "all";
let accepted = [];
let asked = 0;

function recordsOf(name) {
  return name === "all" ? [...recordsAs("train"), ...recordsAs("judge")] : recordsAs(name);
}

function setButtons(again) {
  return el("div", { className: "segments", role: "group", "aria-label": "Records" }, ...kSets.map(([name, text]) =>
    el("button", { type: "button", "aria-pressed": String(name === set), disabled: !recordsOf(name).length, onclick: () => ((set = name), again()) }, text)));
}

/** Models on records as blocks of their report. @param {Element} place @param {string[]} models @param {string[]} records */
export async function showComparison(place, models, records, wanted = () => true) {
  const told = await post("/api/compare", { do: "compare", models, records, accept: accepted });
  return { told, show: () => {
    if (told.text) return place.append(el("pre", {}, told.text), commandLine(told.command));
    const parts = partsOf(told.report);
    place.append(parts.verdict ? document.importNode(parts.verdict, true) : "", commandLine(told.command));
    const links = el("div");
    place.append(links);
    links.replaceWith(sectionLinks([showBlocks(place, parts, wanted)]));
  } };
}

/** @param {Element} place */
export async function showCompare(place) {
  const again = () => showCompare(place);
  const mine = ++asked;
  if (!recordsOf(set).length) set = "all";
  const records = recordsOf(set);
  const head = el("div", { className: "row head" }, el("h1", {}, "Compare"), setButtons(again));
  if (!choice.model || !records.length) {
    forgetPlots();
    place.replaceChildren(head, el("p", { className: "lead" }, choice.model ? "Choose records on the left, or drop them anywhere." : "A model is needed to compare with: choose or drop one (.toml)."));
    return;
  }
  place.classList.add("waiting");
  if (!place.querySelector(".blocks")) place.replaceChildren(head, el("p", { className: "soft" }, "Predicting…"));
  const body = el("div");
  try {
    const { show } = await showComparison(body, [choice.model, ...choice.beside], records);
    if (mine !== asked || !place.isConnected) return;
    forgetPlots();
    place.replaceChildren(head, body);
    show();
  } catch (error) {
    if (mine !== asked) return;
    forgetPlots();
    place.replaceChildren(head, errorBox(error, (words) => ((accepted = [...accepted, ...words]), again())));
  } finally {
    if (mine === asked) place.classList.remove("waiting");
  }
}
