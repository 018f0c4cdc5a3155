// Draws a heat map on a canvas with the colours of the page, a colour scale beside it, and the value at the cursor in
// the legend.
function axisHeatMap(elements, map, resolved, formatted) {
  "use strict";

  const LEFT = 62, RIGHT = 78, TOP = 8, BOTTOM = 44; // pixels round the cells
  const canvas = document.createElement("canvas");
  elements.canvas.appendChild(canvas);
  const last = (cells) => cells.first + cells.step * cells.count;

  function channels(colour) {
    return [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
  }

  // From the paper's colour at zero to the colour of the sign at the limit. The root makes small values visible.
  function painter() {
    const [none, low, high] = ["var(--paper)", "var(--low)", "var(--high)"].map((name) => channels(resolved(name)));
    return function (value) {
      const part = Math.sqrt(Math.min(1, Math.abs(value) / map.limit));
      const end = value < 0 ? low : high;
      return "rgb(" + none.map((from, k) => Math.round(from + (end[k] - from) * part)).join(",") + ")";
    };
  }

  // About five round numbers in [from, to].
  function ticks(from, to) {
    const raw = (to - from) / 5;
    const power = Math.pow(10, Math.floor(Math.log10(raw)));
    const step = [1, 2, 5, 10].map((k) => k * power).find((candidate) => candidate >= raw);
    const found = [];
    for (let k = Math.ceil(from / step); k * step <= to; k++) found.push(k * step);
    return found;
  }

  let area = null;

  function drawCells(context, colourOf) {
    const width = area.w / map.x.count;
    const height = area.h / map.y.count;
    context.fillStyle = resolved("var(--track)");
    context.fillRect(area.x, area.y, area.w, area.h);
    map.values.forEach(function (value, k) {
      if (value === null) return;
      const row = Math.floor(k / map.x.count);
      context.fillStyle = colourOf(value);
      context.fillRect(area.x + (k % map.x.count) * width, area.y + area.h - (row + 1) * height, width + 0.6, height + 0.6);
    });
  }

  function drawScale(context, colourOf) {
    const left = area.x + area.w + 12;
    for (let k = 0; k < area.h; k++) {
      context.fillStyle = colourOf(map.limit * (1 - (2 * k) / area.h));
      context.fillRect(left, area.y + k, 12, 1.5);
    }
    context.fillStyle = resolved("var(--soft)");
    context.textAlign = "left";
    for (const part of [1, 0, -1])
      context.fillText(formatted(Number((part * map.limit).toPrecision(2))), left + 17, area.y + (area.h * (1 - part)) / 2);
  }

  function drawAxes(context) {
    context.fillStyle = resolved("var(--soft)");
    const right = last(map.x), top = last(map.y);
    context.textAlign = "center";
    for (const tick of ticks(map.x.first, right))
      context.fillText(formatted(tick), area.x + (area.w * (tick - map.x.first)) / (right - map.x.first), area.y + area.h + 11);
    context.fillText(map.x.label, area.x + area.w / 2, area.y + area.h + 30);
    context.textAlign = "right";
    for (const tick of ticks(map.y.first, top))
      context.fillText(formatted(tick), area.x - 6, area.y + area.h - (area.h * (tick - map.y.first)) / (top - map.y.first));
    context.save();
    context.translate(12, area.y + area.h / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(map.y.label, 0, 0);
    context.restore();
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = elements.canvas.clientWidth, height = elements.canvas.clientHeight;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    area = { x: LEFT, y: TOP, w: Math.max(1, width - LEFT - RIGHT), h: Math.max(1, height - TOP - BOTTOM) };
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.font = "12px " + getComputedStyle(document.body).fontFamily;
    context.textBaseline = "middle";
    const colourOf = painter();
    drawCells(context, colourOf);
    drawScale(context, colourOf);
    drawAxes(context);
  }

  function tell(text) {
    elements.legend.replaceChildren();
    const title = document.createElement("b");
    title.textContent = map.label;
    const reading = document.createElement("span");
    reading.className = "at";
    reading.textContent = text;
    elements.legend.append(title, reading);
  }

  canvas.addEventListener("mousemove", function (event) {
    const column = Math.floor(((event.offsetX - area.x) / area.w) * map.x.count);
    const row = Math.floor(((area.y + area.h - event.offsetY) / area.h) * map.y.count);
    const inside = column >= 0 && column < map.x.count && row >= 0 && row < map.y.count;
    const value = inside ? map.values[row * map.x.count + column] : null;
    const centre = (cells, k, unit) => formatted(Number((cells.first + (k + 0.5) * cells.step).toPrecision(4))) + " " + unit;
    tell(inside ? formatted(value) + " at " + centre(map.x, column, map.x.unit) + ", " + centre(map.y, row, map.y.unit) : "");
  });
  canvas.addEventListener("mouseleave", () => tell(""));
  tell("");
  draw();
  new ResizeObserver(draw).observe(elements.canvas);
  return draw;
}
