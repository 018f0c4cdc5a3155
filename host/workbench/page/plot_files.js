// Saves a figure: its numbers as CSV, its picture as PNG or SVG.
import { el } from "./elements.js";
import { svgOf } from "./plot_svg.js";

/** Functions of report.js, which is a separate script.
 * @returns {{draw: Function, unpack: (packed: any) => Float64Array}}
 */
export const plots = () => /** @type {any} */ (window).axisPlots;

const word = (text) => (/[",\n]/.test(text) ? '"' + text.replaceAll('"', '""') + '"' : text);

/** CSV with one row for each point.
 * @param {any} plot as report.js draws it
 * @returns {string}
 */
export function csvOf(plot) {
  const rows = [];
  if (plot.kind === "map") {
    rows.push([plot.x.label, plot.y.label, plot.label].map(word).join(","));
    plot.values.forEach((value, k) => {
      const column = k % plot.x.count, row = Math.floor(k / plot.x.count);
      if (value !== null) rows.push([plot.x.first + (column + 0.5) * plot.x.step, plot.y.first + (row + 0.5) * plot.y.step, value].join(","));
    });
  } else if (plot.kind === "time") {
    rows.push(["panel", "series", plot.xLabel, "value"].join(","));
    for (const panel of plot.panels) {
      const x = plots().unpack(panel.x);
      for (const series of panel.series) plots().unpack(series.y).forEach((y, k) => rows.push([word(panel.label), word(series.name), x[k], isNaN(y) ? "" : y].join(",")));
    }
  } else {
    rows.push(["series", word(plot.xLabel), word(plot.label), "lower", "upper", "samples"].join(","));
    for (const one of plot.series) one.x.forEach((x, k) => rows.push([word(one.name), x, one.y[k], one.lower?.[k], one.upper?.[k], one.samples?.[k]].map((value) => value ?? "").join(",")));
  }
  return rows.join("\n") + "\n";
}

/** Picture of a figure: its canvases, colour samples and texts at their positions.
 * @param {HTMLElement} figure
 * @returns {HTMLCanvasElement}
 */
export function pictureOf(figure) {
  const scale = 2, outer = figure.getBoundingClientRect();
  const picture = el("canvas", { width: scale * outer.width, height: scale * outer.height });
  const context = picture.getContext("2d");
  context.scale(scale, scale);
  context.translate(-outer.left, -outer.top);
  context.fillStyle = getComputedStyle(figure).backgroundColor;
  context.fillRect(outer.left, outer.top, outer.width, outer.height);
  for (const part of figure.querySelectorAll("canvas, .swatch")) {
    const box = part.getBoundingClientRect();
    context.fillStyle = getComputedStyle(part).backgroundColor;
    if (part instanceof HTMLCanvasElement) context.drawImage(part, box.left, box.top, box.width, box.height);
    else context.fillRect(box.left, box.top, box.width, box.height);
  }
  context.textBaseline = "middle";
  const texts = document.createTreeWalker(figure, NodeFilter.SHOW_TEXT), range = document.createRange();
  while (texts.nextNode()) {
    const node = /** @type {Text} */ (texts.currentNode);
    if (node.parentElement.closest("button, .tools")) continue;
    const style = getComputedStyle(node.parentElement);
    context.font = style.font;
    context.fillStyle = style.color;
    for (const match of node.data.matchAll(/\S+/g)) {
      range.setStart(node, match.index);
      range.setEnd(node, match.index + match[0].length);
      const box = range.getBoundingClientRect();
      context.fillText(match[0], box.left, box.top + box.height / 2);
    }
  }
  return picture;
}

/**
 * @param {string} name
 * @param {Blob} content
 */
export function save(name, content) {
  const link = el("a", { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Buttons for CSV, PNG and SVG.
 * @param {HTMLElement} figure
 * @param {any} plot
 */
export function fileTools(figure, plot) {
  const title = figure.querySelector("figcaption strong")?.textContent || "plot";
  const name = title.replace(/[^\w.-]+/g, "-").toLowerCase();
  return el("div", { className: "tools" },
    el("button", { type: "button", "aria-label": "Numbers of “" + title + "” as CSV", onclick: () => save(name + ".csv", new Blob([csvOf(plot)], { type: "text/csv" })) }, "CSV"),
    el("button", { type: "button", "aria-label": "“" + title + "” as PNG", onclick: () => pictureOf(figure).toBlob((blob) => save(name + ".png", blob)) }, "PNG"),
    el("button", { type: "button", "aria-label": "“" + title + "” as SVG", onclick: () => save(name + ".svg", new Blob([svgOf(figure, plot)], { type: "image/svg+xml" })) }, "SVG"));
}
