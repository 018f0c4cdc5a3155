// A figure as SVG: the curves of its charts as they are shown, in their present range and scales, and its texts.

const kSpace = "http://www.w3.org/2000/svg";

function add(parent, tag, properties, text) {
  const element = document.createElementNS(kSpace, tag);
  for (const [name, value] of Object.entries(properties)) element.setAttribute(name, String(value));
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

const round = (value) => Math.round(100 * value) / 100;

/** Pieces of a curve without gaps: rows of [x, y, lower, upper] in pixels. */
function piecesOf(chart, column) {
  const pieces = [[]];
  for (let row = 0; row < chart.numRows(); row++) {
    const value = chart.getValue(row, column), [lower, middle, upper] = Array.isArray(value) ? value : [null, value, null];
    if (middle === null && chart.getOption("connectSeparatedPoints")) continue;
    if (middle === null || isNaN(middle)) {
      if (pieces.at(-1).length) pieces.push([]);
      continue;
    }
    const y = (one) => (one === null || isNaN(one) ? null : round(chart.toDomYCoord(one)));
    pieces.at(-1).push([round(chart.toDomXCoord(chart.getValue(row, 0))), y(middle), y(lower), y(upper)]);
  }
  return pieces.filter((piece) => piece.length);
}

const path = (points) => points.map(([x, y], k) => (k ? "L" : "M") + x + " " + y).join("");

/** @param {any} group @param {any} chart a dygraph @param {any[]} series its styles, by column */
function drawChart(group, chart, series) {
  const area = chart.getArea(), clip = "clip-" + Math.random().toString(36).slice(2);
  add(add(group, "clipPath", { id: clip }), "rect", { x: area.x, y: area.y, width: area.w, height: area.h });
  const inside = add(group, "g", { "clip-path": `url(#${clip})`, fill: "none" });
  chart.getLabels().slice(1).forEach((name, k) => {
    if (!chart.visibility()[k]) return;
    const colour = chart.getColors()[chart.visibility().slice(0, k).filter(Boolean).length] || "currentColor", style = series[k] || {};
    const bottom = area.y + area.h, zero = chart.getOption("logscale") ? bottom : chart.toDomYCoord(0);
    for (const piece of piecesOf(chart, k + 1)) {
      const band = piece.filter((point) => point[2] !== null && point[2] !== point[3]);
      if (band.length > 1) add(inside, "path", { d: path(band.map(([x, , low]) => [x, low])) + path(band.map(([x, , , high]) => [x, high]).reverse()).replace("M", "L") + "Z", fill: colour, "fill-opacity": 0.15 });
      if (style.style !== "points" && style.style !== "stems") add(inside, "path", { d: path(piece), stroke: colour, "stroke-width": chart.getOption("strokeWidth", name) || 1.5, ...(style.dashed ? { "stroke-dasharray": "7 4" } : {}) });
      if (style.style === "stems") add(inside, "path", { d: piece.map(([x, y]) => "M" + x + " " + round(zero) + "L" + x + " " + y).join(""), stroke: colour, "stroke-width": 1.5 });
      if (style.style && style.style !== "line") for (const [x, y] of piece) add(inside, "circle", { cx: x, cy: y, r: piece.length > 400 ? 1 : 2.5, fill: colour });
    }
  });
  add(group, "path", { d: `M${area.x} ${area.y}V${area.y + area.h}H${area.x + area.w}`, fill: "none", stroke: chart.getOption("axisLineColor") || "currentColor" });
}

/**
 * @param {HTMLElement} figure
 * @param {any} plot as report.js draws it
 * @returns {string}
 */
export function svgOf(figure, plot) {
  const outer = figure.getBoundingClientRect(), colours = getComputedStyle(figure);
  const svg = document.createElementNS(kSpace, "svg");
  for (const [name, value] of Object.entries({ xmlns: kSpace, width: outer.width, height: outer.height, viewBox: `0 0 ${outer.width} ${outer.height}` })) svg.setAttribute(name, String(value));
  add(svg, "rect", { width: outer.width, height: outer.height, fill: colours.backgroundColor });
  const place = (element) => {
    const box = element.getBoundingClientRect();
    return { x: round(box.left - outer.left), y: round(box.top - outer.top), width: round(box.width), height: round(box.height) };
  };
  const charts = /** @type {any} */ (window).axisCharts.filter((chart) => figure.contains(chart.graphDiv));
  charts.forEach((chart, index) => {
    const at = place(chart.graphDiv);
    drawChart(add(svg, "g", { transform: `translate(${at.x} ${at.y})` }), chart, plot.kind === "time" ? plot.panels[index].series : plot.series);
  });
  // A map is a picture of cells.
  if (!charts.length) for (const canvas of figure.querySelectorAll("canvas")) add(svg, "image", { ...place(canvas), href: canvas.toDataURL() });
  for (const swatch of figure.querySelectorAll(".swatch")) add(svg, "rect", { ...place(swatch), fill: getComputedStyle(swatch).backgroundColor });
  const texts = document.createTreeWalker(figure, NodeFilter.SHOW_TEXT), range = document.createRange();
  while (texts.nextNode()) {
    const node = /** @type {Text} */ (texts.currentNode);
    if (node.parentElement.closest("button, .tools")) continue;
    const style = getComputedStyle(node.parentElement);
    for (const match of node.data.matchAll(/\S+/g)) {
      range.setStart(node, match.index);
      range.setEnd(node, match.index + match[0].length);
      const box = place(range);
      add(svg, "text", { x: box.x, y: box.y + box.height / 2, "dominant-baseline": "central", fill: style.color, "font-family": style.fontFamily, "font-size": style.fontSize, "font-weight": style.fontWeight }, match[0]);
    }
  }
  return new XMLSerializer().serializeToString(svg);
}
