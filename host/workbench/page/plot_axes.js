// Axes of a plot: linear or logarithmic.
import { el } from "./elements.js";

/** Whether all values have the same sign, so that a logarithmic axis of magnitudes is possible. */
const hasOneSign = (values) => values.some((value) => value !== 0) && (values.every((value) => value >= 0) || values.every((value) => value <= 0));

/** Buttons for the axes that can be logarithmic.
 * @param {any} frame in which report.js has drawn the plot
 * @param {any} plot
 * @returns {HTMLElement[]}
 */
export function axisTools(frame, plot) {
  if (plot.kind === "time" || plot.kind === "map" || !frame.axisScales) return [];
  const scales = frame.axisScales;
  const button = (axis, text) =>
    el("button", {
      type: "button", "aria-pressed": String(Boolean(scales[axis])), title: "Magnitudes on a logarithmic axis",
      onclick: (event) => {
        scales.set({ ...scales, [axis]: !scales[axis] });
        event.target.setAttribute("aria-pressed", String(scales[axis]));
      },
    }, text);
  return [...(plot.series.every((one) => hasOneSign(one.x)) ? [button("x", "log x")] : []), button("y", "log y")];
}
