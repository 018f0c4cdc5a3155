// Shows reports of the commands as parts of this page, with the same blocks and plots, drawn by the same script.
import { axisTools } from "./plot_axes.js";
import { fileTools, plots as plotScript } from "./plot_files.js";

/** Shows the details of a verdict on demand, so that the picture below it is seen at once.
 * @param {Element|null|undefined} details
 */
function fold(details) {
  if (!details) return;
  const folded = document.createElement("details"), summary = document.createElement("summary");
  summary.textContent = "What to record next, and more";
  details.replaceWith(folded);
  folded.append(summary, ...details.children);
}

/**
 * @typedef {{verdict: Element|null, blocks: Element[], plots: any[]}} ReportParts
 * @param {string} html a report that the program wrote
 * @returns {ReportParts}
 */
export function partsOf(html) {
  const page = new DOMParser().parseFromString(html, "text/html");
  const carried = page.getElementById("plots"), verdict = page.querySelector("main > .verdict");
  fold(verdict?.querySelector(".details"));
  return {
    verdict,
    blocks: [...(page.querySelector("main > .blocks")?.children || [])],
    plots: carried ? JSON.parse(carried.textContent) : [],
  };
}

/** @type {{box: Element, forget: () => void}[]} */
let drawn = [];

/** Destroys all plots, or those in a place. Called before a view is removed.
 * @param {Element} [place]
 */
export function forgetPlots(place) {
  const gone = drawn.filter((one) => !place || place.contains(one.box));
  gone.forEach((one) => one.forget());
  drawn = drawn.filter((one) => !gone.includes(one));
}

/** Draws one plot from data without a report.
 * @param {Element} frame in the page
 * @param {any} plot as report.js draws it
 */
export function showPlot(frame, plot) {
  drawn.push({ box: frame, forget: plotScript().draw([plot], [frame]) });
}

/**
 * Puts the blocks into the page and draws their plots. Removes the ids of the frames, because a view may contain
 * several reports.
 * @param {Element} place
 * @param {ReportParts} parts
 * @param {(block: Element) => boolean} [wanted]
 * @param {(plot: any, canvas: Element, from: number, to: number) => void} [onZoom]
 * @param {(figure: HTMLElement, plot: any) => HTMLElement[]} [moreTools] further buttons of a figure
 */
export function showBlocks(place, parts, wanted = () => true, onZoom, moreTools = () => []) {
  const frames = [], plots = [];
  const box = document.createElement("div");
  box.className = "blocks";
  for (const block of parts.blocks) {
    if (!wanted(block)) continue;
    box.append(document.importNode(block, true));
  }
  place.append(box);
  for (const frame of box.querySelectorAll("[id^=plot-]")) {
    frames.push(frame);
    plots.push(parts.plots[Number(frame.id.slice(5))]);
    frame.removeAttribute("id");
    frame.closest("figure").prepend(fileTools(frame.closest("figure"), plots.at(-1)));
  }
  const show = (/** @type {number} */ k) => {
    drawn.push({ box: frames[k], forget: plotScript().draw([plots[k]], [frames[k]], onZoom) });
    const figure = frames[k].closest("figure");
    figure.querySelector(".tools").prepend(...moreTools(figure, plots[k]), ...axisTools(frames[k], plots[k]));
  };
  // The first picture is on the screen before the others are drawn. A page that is scrolled keeps its place.
  const from = window.scrollY > 0 ? frames.length : 1;
  frames.slice(0, from).forEach((_, k) => show(k));
  const next = (/** @type {number} */ k) => {
    if (k >= frames.length) return;
    setTimeout(() => {
      if (!box.isConnected) return;
      show(k);
      next(k + 1);
    });
  };
  requestAnimationFrame(() => next(from));
  return box;
}

/**
 * Links to the sections of the boxes.
 * @param {Element[]} boxes
 */
export function sectionLinks(boxes) {
  const list = document.createElement("nav");
  list.className = "sections";
  list.setAttribute("aria-label", "Sections");
  for (const heading of boxes.flatMap((box) => [...box.querySelectorAll("h2")])) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = heading.textContent;
    button.addEventListener("click", () => heading.scrollIntoView({ behavior: "smooth" }));
    list.append(button);
  }
  return list;
}
