// Draws plots with dygraphs into the frames "plot-N". In a report, the element "plots" contains the data. The workbench
// fetches the data and calls axisPlots.draw.
(function () {
  "use strict";

  const GAP = 0xffffff;
  // Most intervals drawn in the visible range. All samples are kept, so zooming in shows every one of them.
  const VISIBLE_STRETCHES = 1500;
  const VISIBLE_ROWS = 3 * VISIBLE_STRETCHES; // up to these, every sample is drawn
  const PIXELS_OF_A_STRETCH = 2; // its lowest and highest value have two places
  const HIDDEN_STRETCHES = 200;
  const VALUE_AXIS_WIDTH = 62; // pixels; the same in all panels of a stack, so that their time axes line up
  const charts = [];
  let zoomed = null; // called after every manual zoom, with plot, frame and range
  const recolour = []; // called when the page changes between light and dark, or is printed

  // Replaces "var(--name)" by its colour in the present colour scheme.
  function resolved(colour) {
    const name = /^var\((--[a-z-]+)\)$/.exec(colour);
    return name ? getComputedStyle(document.documentElement).getPropertyValue(name[1]).trim() : colour;
  }

  function unpack(packed) {
    const bytes = atob(packed.base64);
    const values = new Float64Array(bytes.length / 3);
    for (let k = 0; k < values.length; k++) {
      const code = (bytes.charCodeAt(3 * k) << 16) | (bytes.charCodeAt(3 * k + 1) << 8) | bytes.charCodeAt(3 * k + 2);
      values[k] = code === GAP ? NaN : packed.lowest + code * packed.step;
    }
    return values;
  }

  // The first row whose x is not below the limit; x must ascend.
  function firstRowFrom(x, limit) {
    let low = 0;
    let high = x.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (x[middle] < limit) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // Adds the rows of [from, to) with the extremes of each interval, so that no spike is lost.
  function pushExtremes(columns, from, to, stretches, rows) {
    if (to - from <= 3 * stretches) {
      for (let row = from; row < to; row++) rows.push(row);
      return;
    }
    for (let stretch = 0; stretch < stretches; stretch++) {
      const begin = from + Math.floor(((to - from) * stretch) / stretches);
      const end = from + Math.floor(((to - from) * (stretch + 1)) / stretches);
      const chosen = new Set([begin]);
      for (const column of columns) {
        let lowest = -1;
        let highest = -1;
        let gap = -1;
        for (let row = begin; row < end; row++) {
          if (isNaN(column[row])) {
            if (gap < 0) gap = row;
            continue;
          }
          if (lowest < 0 || column[row] < column[lowest]) lowest = row;
          if (highest < 0 || column[row] > column[highest]) highest = row;
        }
        [lowest, highest, gap].filter((row) => row >= 0).forEach((row) => chosen.add(row));
      }
      rows.push(...[...chosen].sort((a, b) => a - b));
    }
  }

  // Rows for dygraphs: fine inside the window, coarse outside, so that the whole range can be shown after a reset of
  // the zoom.
  function drawnRows(x, columns, window, width) {
    const from = window ? Math.max(0, firstRowFrom(x, window[0]) - 1) : 0;
    const to = window ? Math.min(x.length, firstRowFrom(x, window[1]) + 1) : x.length;
    const rows = [];
    pushExtremes(columns, 0, from, HIDDEN_STRETCHES, rows);
    const seen = Math.max(HIDDEN_STRETCHES, Math.ceil((width * devicePixelRatio) / PIXELS_OF_A_STRETCH));
    const isWhole = to - from <= VISIBLE_ROWS;
    pushExtremes(columns, from, to, isWhole ? VISIBLE_ROWS : Math.min(VISIBLE_STRETCHES, seen), rows);
    pushExtremes(columns, to, x.length, HIDDEN_STRETCHES, rows);
    return rows.map((row) => [x[row], ...columns.map((column) => column[row])]);
  }

  function formatted(value) {
    if (value === null || value === undefined || !isFinite(value)) return "–";
    return String(Number(value.toPrecision(5)));
  }

  function addElement(parent, tag, className, text) {
    const element = document.createElement(tag);
    if (className) element.className = className;
    if (text !== undefined) element.textContent = text;
    parent.appendChild(element);
    return element;
  }

  // The quantity and its unit, then each series with its colour and its value at the cursor.
  function legendOf(plot, panel, xUnit) {
    return function (data) {
      const content = document.createDocumentFragment();
      addElement(content, "b", "", panel.label);
      data.series.forEach(function (series, index) {
        const item = addElement(content, "span", series.isVisible ? "" : "off");
        item.title = "Click to hide or show it";
        const swatch = addElement(item, "i", "swatch" + (panel.series[index].style === "points" ? " dot" : ""));
        const colour = panel.series[index].colour;
        swatch.style.background = panel.series[index].dashed
          ? "repeating-linear-gradient(90deg, " + colour + " 0 5px, transparent 5px 8px)"
          : colour;
        addElement(item, "span", "", series.label);
        const chosen = data.x !== undefined && series.y !== undefined && series.y !== null && !isNaN(series.y);
        const own = panel.series[index];
        const samples = chosen && own.samples ? own.samples[own.x.indexOf(data.x)] : undefined;
        const marked = chosen && plot.reference ? plot.reference.values.get(panel)?.[index] : undefined;
        const apart = marked === undefined || isNaN(marked) ? "" : ", Δ " + formatted(series.y - marked);
        const reading = chosen ? formatted(series.y) + apart + (samples ? " (" + samples + " samples)" : "") : "";
        addElement(item, "span", "reading", reading);
      });
      if (data.x !== undefined) addElement(content, "span", "at", "at " + formatted(data.x) + (xUnit ? " " + xUnit : "") + distance(plot, data.x, xUnit));
      return content;
    };
  }

  // Distance from the reference that was set by a click: along x and, if x is in seconds, also the frequency with this
  // period.
  function distance(plot, x, xUnit) {
    if (!plot.reference || x === plot.reference.x) return "";
    const apart = x - plot.reference.x;
    return ", Δ " + formatted(apart) + (xUnit === "s" ? " (" + formatted(1 / Math.abs(apart)) + " Hz)" : "");
  }

  // The last value of each series up to x.
  function valuesUpTo(chart, x, count) {
    const values = new Array(count).fill(NaN);
    for (let row = 0; row < chart.numRows() && chart.getValue(row, 0) <= x; row++)
      for (let column = 0; column < count; column++) {
        const value = chart.getValue(row, column + 1);
        const plain = Array.isArray(value) ? value[1] : value;
        if (plain !== null && !isNaN(plain)) values[column] = plain;
      }
    return values;
  }

  // A click sets the reference in all panels of a plot. A click on the reference removes it.
  function mark(plot, chart, x) {
    const near = plot.reference && Math.abs(chart.toDomXCoord(plot.reference.x) - chart.toDomXCoord(x)) < 6;
    plot.reference = near ? null : { x: x, values: new Map() };
    for (const [panel, own] of plot.drawn) {
      if (plot.reference) plot.reference.values.set(panel, valuesUpTo(own, x, panel.series.length));
      own.updateOptions({}); // draws the line
    }
  }

  function coloursOf(panel) {
    return {
      colors: panel.series.map((series) => resolved(series.colour)),
      gridLineColor: resolved("var(--grid)"),
      axisLineColor: resolved("var(--axis)"),
    };
  }

  function keep(chart, plot, panel, legend) {
    charts.push(chart);
    (plot.drawn = plot.drawn || []).push([panel, chart]);
    chart.updateOptions({ clickCallback: (event, x) => mark(plot, chart, x) }, true);
    legend.addEventListener("click", function (event) {
      const item = [...legend.querySelectorAll(":scope > span:not(.at)")].indexOf(event.target.closest(".legend > span"));
      if (item >= 0) chart.setVisibility(item, !chart.visibility()[item]);
    });
    recolour.push(() => chart.updateOptions(coloursOf(panel)));
    return chart;
  }

  // Description for screen readers: what is drawn, and its range of values.
  function spoken(label, xLabel, series) {
    const ranges = series.map(function (one) {
      const values = one.values.filter((value) => value !== null && isFinite(value));
      const text = values.reduce((range, value) => [Math.min(range[0], value), Math.max(range[1], value)], [Infinity, -Infinity]);
      return one.name + (values.length ? " from " + formatted(text[0]) + " to " + formatted(text[1]) : " without values");
    });
    return label + " over " + xLabel + ": " + ranges.join("; ");
  }

  function commonOptions(plot, panel, elements, isLowest, xUnit) {
    const tell = zoomed;
    return {
      zoomCallback: tell && ((from, to) => tell(plot, elements.canvas, from, to)),
      labels: [plot.xLabel, ...panel.series.map((series) => series.name)],
      ...coloursOf(panel),
      labelsDiv: elements.legend,
      legend: "always",
      legendFormatter: legendOf(plot, panel, xUnit),
      xlabel: isLowest ? plot.xLabel : null,
      axes: {
        x: { drawAxis: isLowest, axisLabelWidth: 70, pixelsPerLabel: innerWidth < 600 ? 40 : 70, valueFormatter: formatted,
          axisLabelFormatter: formatted },
        y: { axisLabelWidth: VALUE_AXIS_WIDTH, valueFormatter: formatted, axisLabelFormatter: formatted },
      },
      axisLabelFontSize: 12,
      xLabelHeight: 20,
      highlightCircleSize: 3,
      animatedZooms: false,
    };
  }

  function panelElements(frame, label, className) {
    const box = addElement(frame, "div", "panel");
    const elements = { legend: addElement(box, "div", "legend"), canvas: addElement(box, "div", "canvas " + className) };
    elements.canvas.setAttribute("role", "img");
    elements.canvas.setAttribute("aria-label", label);
    return elements;
  }

  // The number of samples per point, as grey columns at the bottom. The tallest column is the fullest bin of the plot.
  function drawSampleStrip(context, area, chart, series) {
    const most = Math.max(...series.flatMap((one) => one.samples || [0]));
    if (!(most > 0)) return;
    context.fillStyle = resolved("var(--grid)");
    for (const one of series)
      (one.samples || []).forEach(function (count, k) {
        if (!count) return;
        const height = Math.max(2, 0.1 * area.h * Math.sqrt(count / most));
        context.fillRect(chart.toDomXCoord(one.x[k]) - 2, area.y + area.h - height, 4, height);
      });
  }

  // Background of the traces: the shaded spans, a line at zero, and the reference.
  function background(plot, spans, series) {
    return function (context, area, chart) {
      if (plot.reference) {
        context.fillStyle = resolved("var(--ink)");
        context.fillRect(Math.round(chart.toDomXCoord(plot.reference.x)), area.y, 1, area.h);
      }
      if (chart.getOption("logscale")) return;
      drawSampleStrip(context, area, chart, series || []);
      const zero = chart.toDomYCoord(0);
      if (zero > area.y && zero < area.y + area.h) {
        context.fillStyle = resolved("var(--axis)");
        context.fillRect(area.x, Math.round(zero), area.w, 1);
      }
      context.fillStyle = resolved("var(--shade)");
      for (const span of spans) {
        const left = chart.toDomXCoord(span[0]);
        const right = chart.toDomXCoord(span[1]);
        context.fillRect(left, area.y, Math.max(1, right - left), area.h);
      }
    };
  }

  function drawPanel(frame, plot, panel, isLowest) {
    const x = unpack(panel.x);
    const columns = panel.series.map((series) => unpack(series.y));
    const elements = panelElements(
      frame,
      spoken(panel.label, "time", panel.series.map((series, index) => ({ name: series.name, values: columns[index] }))),
      isLowest ? "lowest" : ""
    );
    let drawnWindow = null;
    let timer = 0;
    const options = commonOptions(plot, panel, elements, isLowest, "s");
    options.underlayCallback = background(plot, plot.shaded);
    options.series = {};
    panel.series.forEach((series) => (options.series[series.name] = { strokeWidth: series.wide ? 2.6 : 1.2 }));
    options.drawCallback = function (chart, isFirst) {
      if (isFirst) return;
      const window = chart.isZoomed("x") ? chart.xAxisRange() : null;
      if (String(window) === String(drawnWindow)) return;
      clearTimeout(timer);
      timer = setTimeout(function () {
        drawnWindow = window;
        chart.updateOptions({ file: drawnRows(x, columns, window, elements.canvas.clientWidth) });
      }, 30);
    };
    return keep(new Dygraph(elements.canvas, drawnRows(x, columns, null, elements.canvas.clientWidth), options), plot, panel, elements.legend);
  }

  function drawTimePlot(frame, plot) {
    const stacked = plot.panels.map((panel, index) => drawPanel(frame, plot, panel, index === plot.panels.length - 1));
    if (stacked.length > 1) Dygraph.synchronize(stacked, { zoom: true, selection: true, range: false });
  }

  function drawStems(event) {
    const context = event.drawingContext;
    const zero = event.dygraph.getOption("logscale") ? event.plotArea.y + event.plotArea.h : event.dygraph.toDomYCoord(0);
    context.strokeStyle = event.color;
    context.lineWidth = 1.5;
    for (const point of event.points) {
      if (isNaN(point.canvasy)) continue;
      context.beginPath();
      context.moveTo(point.canvasx, zero);
      context.lineTo(point.canvasx, point.canvasy);
      context.stroke();
    }
  }

  function drawErrorBars(event) {
    const context = event.drawingContext;
    const area = event.plotArea;
    context.strokeStyle = event.color;
    context.lineWidth = 1;
    for (const point of event.points) {
      if (isNaN(point.canvasy) || isNaN(point.y_top) || point.y_top === point.y_bottom) continue;
      const top = area.y + area.h * point.y_bottom;
      const bottom = area.y + area.h * point.y_top;
      context.beginPath();
      context.moveTo(point.canvasx, top);
      context.lineTo(point.canvasx, bottom);
      context.moveTo(point.canvasx - 3, top);
      context.lineTo(point.canvasx + 3, top);
      context.moveTo(point.canvasx - 3, bottom);
      context.lineTo(point.canvasx + 3, bottom);
      context.stroke();
    }
  }

  function seriesOptions(series) {
    const withLine = series.style === "line" || series.style === "line_and_points";
    const withPoints = series.style !== "line";
    const plotters = [Dygraph.Plotters.linePlotter];
    if (series.style === "stems") plotters.unshift(drawStems);
    if (series.lower) plotters.unshift(withLine ? Dygraph.Plotters.errorPlotter : drawErrorBars);
    const many = series.x.length > 400;
    return {
      plotter: (event) => plotters.forEach((plotter) => plotter(event)),
      drawPoints: withPoints,
      pointSize: series.style === "stems" ? 2 : many ? 1 : 3,
      strokeWidth: withLine ? 2 : 0,
      strokePattern: series.dashed ? [7, 4] : null,
    };
  }

  // One row for each x of any series: null if a series has no point there, NaN if it has a gap.
  function mergedRows(plot, withBars) {
    const rows = new Map();
    plot.series.forEach(function (series, index) {
      series.x.forEach(function (x, k) {
        // A second point at the same x needs another row.
        let row = (rows.get(x) || []).find((candidate) => candidate[index + 1] === null);
        if (!row) {
          row = [x, ...plot.series.map(() => null)];
          rows.set(x, [...(rows.get(x) || []), row]);
        }
        const value = series.y[k] === null || (plot.logarithmic && series.y[k] <= 0) ? NaN : series.y[k];
        row[index + 1] = !withBars ? value : series.lower ? [series.lower[k], value, series.upper[k]] : [value, value, value];
      });
    });
    return [...rows.values()].flat().sort((a, b) => a[0] - b[0]);
  }

  function drawScatterPlot(frame, plot) {
    const withBars = plot.series.some((series) => series.lower);
    const elements = panelElements(
      frame,
      spoken(plot.label, plot.xLabel, plot.series.map((series) => ({ name: series.name, values: series.y }))),
      plot.equal ? "plane" : plot.large ? "large" : "scatter"
    );
    const options = commonOptions(plot, plot, elements, true, plot.xUnit);
    options.customBars = withBars;
    options.connectSeparatedPoints = true;
    options.logscale = plot.logarithmic;
    options.axes.x.logscale = plot.logarithmicX;
    options.underlayCallback = background(plot, [], plot.series);
    options.series = {};
    plot.series.forEach((series) => (options.series[series.name] = seriesOptions(series)));
    options.xRangePad = plot.logarithmicX ? 0 : 12;
    options.yRangePad = plot.logarithmic || plot.equal ? null : 12;
    if (plot.yRange) options.valueRange = plot.yRange;
    if (plot.logarithmicX) options.dateWindow = logarithmicWindow(plot.series.flatMap((one) => one.x));
    const chart = keep(new Dygraph(elements.canvas, mergedRows(plot, withBars), options), plot, plot, elements.legend);
    if (!plot.equal) frame.axisScales = scalesOf(chart, plot, withBars);
    if (plot.equal) equaliseScales(chart, plot);
  }

  // Begins and ends somewhat beyond the values, because dygraphs pads only linear axes.
  function logarithmicWindow(values) {
    const range = values.filter((value) => value > 0).reduce((r, value) => [Math.min(r[0], value), Math.max(r[1], value)], [Infinity, -Infinity]);
    return range[1] > range[0] ? [range[0] / 1.04, range[1] * 1.04] : null;
  }

  // Whether x and y are logarithmic, and functions to change it. Logarithmic axes show magnitudes without bars.
  function scalesOf(chart, plot, withBars) {
    const scales = { x: Boolean(plot.logarithmicX), y: Boolean(plot.logarithmic) };
    const magnitude = (value) => (value === null ? null : Math.abs(value));
    scales.set = function (wanted) {
      scales.x = Boolean(wanted.x);
      scales.y = Boolean(wanted.y);
      const series = plot.series.map(function (one) {
        const kept = one.x.map((x, k) => k).filter((k) => !scales.x || one.x[k] !== 0);
        const of = (values, change) => values && kept.map((k) => change(values[k]));
        const same = (value) => value;
        return { x: of(one.x, scales.x ? magnitude : same), y: of(one.y, scales.y ? magnitude : same),
          lower: scales.y && !plot.logarithmic ? null : of(one.lower, same), upper: of(one.upper, same) };
      });
      chart.updateOptions({
        file: mergedRows({ series: series, logarithmic: scales.y }, withBars), logscale: scales.y, dateWindow: null, valueRange: scales.y ? null : plot.yRange || null,
        xRangePad: scales.x ? 0 : 12, yRangePad: scales.y ? null : 12, axes: { x: { logscale: scales.x } },
        xlabel: (scales.x && !plot.logarithmicX ? "magnitude of " : "") + plot.xLabel,
      });
    };
    return scales;
  }

  // Equal scales of x and y: at first with the drawing in the middle, and after every zoom, resize and reset.
  function equaliseScales(chart, plot) {
    const range = function (name) {
      const values = plot.series.flatMap((series) => series[name]).filter((value) => value !== null);
      return values.reduce((r, value) => [Math.min(r[0], value), Math.max(r[1], value)], [Infinity, -Infinity]);
    };
    const x = range("x");
    const y = range("y");
    const show = function (unit, horizontal, vertical) {
      const area = chart.getArea();
      const about = (r, pixels) => [(r[0] + r[1] - unit * pixels) / 2, (r[0] + r[1] + unit * pixels) / 2];
      chart.updateOptions({ dateWindow: about(horizontal, area.w), valueRange: about(vertical, area.h) });
    };
    const lengths = (horizontal, vertical) => [
      (horizontal[1] - horizontal[0]) / chart.getArea().w,
      (vertical[1] - vertical[0]) / chart.getArea().h,
    ];
    const whole = () => show(1.08 * Math.max(...lengths(x, y)), x, y);
    // Dragging zooms one axis, which then has the shorter unit. A reset forgets the window of x.
    const zoomed = () => show(Math.min(...lengths(chart.xAxisRange(), chart.yAxisRange())), chart.xAxisRange(), chart.yAxisRange());
    chart.updateOptions({ zoomCallback: () => (chart.isZoomed("x") ? zoomed() : whole()) });
    whole();
    // dygraphs itself reacts only to the size of the window; a destroyed chart has no graphDiv.
    const observer = new ResizeObserver(() => (chart.graphDiv ? (chart.resize(), whole()) : observer.disconnect()));
    observer.observe(chart.graphDiv.parentElement);
  }

  // Draws each plot into its frame; returns a function that removes the plots. `onZoom` may be absent.
  function draw(plots, frames, onZoom) {
    zoomed = onZoom || null;
    const drawn = charts.length;
    const coloured = recolour.length;
    plots.forEach(function (plot, index) {
      const frame = frames[index];
      if (plot.kind === "time") drawTimePlot(frame, plot);
      else if (plot.kind === "map") recolour.push(axisHeatMap(panelElements(frame, plot.label, "map"), plot, resolved, formatted));
      else drawScatterPlot(frame, plot);
    });
    const own = charts.slice(drawn);
    const ownColours = recolour.slice(coloured);
    return function () {
      own.forEach((chart) => (chart.destroy(), charts.splice(charts.indexOf(chart), 1)));
      ownColours.forEach((again) => recolour.splice(recolour.indexOf(again), 1));
    };
  }
  for (const query of ["(prefers-color-scheme: dark)", "print"])
    matchMedia(query).addEventListener("change", () => recolour.forEach((again) => again()));
  // Values for printing by report.css: the width of the contents, and the factor by which they fit a page in landscape.
  function notePrintSize() {
    const main = document.querySelector("main");
    const style = getComputedStyle(main);
    const width = main.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    const root = document.documentElement.style;
    root.setProperty("--screen-width", width + "px");
    root.setProperty("--print-zoom", Math.min(1, 960 / width));
  }
  window.axisCharts = charts;
  window.axisPlots = { draw: draw, unpack: unpack };
  const carried = document.getElementById("plots");
  if (!carried) return;
  const plots = JSON.parse(carried.textContent);
  draw(plots, plots.map((plot, index) => document.getElementById("plot-" + index)));
  notePrintSize();
  window.addEventListener("resize", () => matchMedia("print").matches || notePrintSize());
})();
