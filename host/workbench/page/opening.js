// Opens logs of any controller: shows the recognised channels and makes records.
import { giveRoles, isForJudging } from "./choice.js";
import { commandLine, el, notice, percent, short } from "./elements.js";
import { post } from "./exchange.js";

let asked = 0;

/**
 * @param {Element} place
 * @param {string[]} logs
 */
export async function showOpening(place, logs) {
  place.replaceChildren(el("h1", {}, logs.join(", ")), el("p", { className: "soft" }, "Reading…"));
  await open(place, logs, false);
}

function channels(file) {
  const heads = ["channel", "taken as", "factor", "sure", "why"].map((text) => el("th", { scope: "col" }, text));
  const rows = file.channels.map((channel) => el("tr", {}, el("td", {}, channel.name), el("td", {}, channel.taken_as || "–"), el("td", { className: "number" }, channel.taken_as ? short(channel.factor) : ""),
    el("td", { className: "number" }, percent(channel.sure)), el("td", {}, channel.why)));
  return el("figure", { className: "table" },
    el("figcaption", {}, el("strong", {}, file.file), el("span", {}, file.layout + (file.rate_Hz > 0 ? ", " + short(file.rate_Hz) + " Hz" : ""))),
    el("div", { className: "scroll" }, el("table", {}, el("thead", {}, el("tr", {}, ...heads)), el("tbody", {}, ...rows))),
    ...file.missing.map((text) => el("p", {}, "Missing: " + text)), file.next ? el("p", {}, "Next: " + file.next) : "");
}

async function open(place, logs, yes) {
  const mine = ++asked;
  const { document: told, command } = await post("/api/open", { logs, yes });
  if (told.records.length) {
    notice("In the folder: " + told.records.join(", "));
    await giveRoles(Object.fromEntries(told.records.map((record) => [record, isForJudging(record) ? "judge" : "train"])));
    location.hash = "#compare";
    return;
  }
  if (mine !== asked) return;
  const accept = () => open(place, logs, true).catch((error) => notice(error.message));
  place.replaceChildren(
    el("h1", {}, logs.join(", ")),
    el("p", { className: "lead" }, told.asks.length ? "Is this right?" : "No record can be made from this yet; see below what is missing."),
    ...told.asks.map((ask) => el("p", {}, ask)),
    told.asks.length ? el("button", { type: "button", className: "primary", id: "accept-opening", onclick: accept }, "Correct: make records") : "",
    commandLine(command), ...told.files.map(channels));
}
