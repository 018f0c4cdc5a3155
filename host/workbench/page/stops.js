// Programs on a board that wait at a stop (M0, M1), and the button and the key that continue them.
import { el, notice } from "./elements.js";
import { get, post } from "./exchange.js";

export const stopsPlace = el("div", { id: "stops" });
/** @type {{id: string, program: string, line: number}[]} */
let stops = [];

function draw() {
  const word = stops.length === 1 ? "Continue (Enter)" : "Continue";
  stopsPlace.replaceChildren(...stops.map((stop) => el("section", { className: "verdict", role: "alert" },
    el("span", { className: "badge" }, "waits"),
    el("h2", {}, stop.program + " waits for its operator in line " + stop.line + "."),
    el("p", {}, "The axes move when it continues."),
    el("button", { type: "button", onclick: () => carryOn(stop) }, word))));
}

export async function watchStops() {
  let pause_ms = 500;
  try {
    const now = (await get("/api/stops")).stops;
    if (JSON.stringify(now) !== JSON.stringify(stops)) {
      stops = now;
      draw();
    }
  } catch {
    pause_ms = 5000; // other requests report that the program has ended
  }
  setTimeout(watchStops, pause_ms);
}

async function carryOn(stop) {
  await post("/api/stops/" + stop.id + "/continue", {}).catch((error) => notice(error.message));
}

/** For Enter: continues the only program that waits. */
export function continueTheOne() {
  if (stops.length === 1) carryOn(stops[0]);
}
