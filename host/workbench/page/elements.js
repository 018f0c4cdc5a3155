// Makes HTML elements from data. Text is never interpreted as markup.

/**
 * @param {string} tag
 * @param {Object<string, any>} properties
 * @param {...(Node|string|null)} children
 * @returns {any}
 */
export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "className" || name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

let noticeTimer = 0;

/** Shows a short message, also to screen readers.
 * @param {string} text
 */
export function notice(text) {
  const box = document.getElementById("notice");
  box.textContent = text;
  box.classList.add("shown");
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => box.classList.remove("shown"), 6000);
}

/** The equivalent command, to copy.
 * @param {string} command
 */
export function commandLine(command) {
  const copy = async () => {
    await navigator.clipboard.writeText(command);
    notice("Copied: paste it into a shell in the folder.");
  };
  return el("div", { className: "command" }, el("code", {}, command), el("button", { type: "button", onclick: copy }, "Copy"));
}

/** An error with its remedy.
 * @param {Error & {log?: any[]}} error
 * @param {(words: string[]) => void} [accept]
 */
export function errorBox(error, accept) {
  const fatal = (error.log || []).filter((fault) => fault.kind);
  const box = el("section", { className: "verdict bad", role: "alert" }, el("span", { className: "badge" }, "not possible"), el("h2", {}, error.message));
  if (fatal.length && accept) {
    const words = [...new Set(fatal.map((fault) => fault.kind))];
    box.append(el("p", {}, "Correct the record, or continue anyway."), el("button", { type: "button", onclick: () => accept(words) }, "Accept: " + words.join(", ")));
  }
  return box;
}

/**
 * Three significant digits, as the commands print.
 * @param {number|null|undefined} value
 */
export function short(value) {
  return value === null || value === undefined || !isFinite(value) ? "–" : String(Number(value.toPrecision(3)));
}

/** @param {number} share 0 to 1 */
export function percent(share) {
  return share > 0 && share < 0.01 ? "< 1 %" : share < 1 && share > 0.99 ? "> 99 %" : Math.round(100 * share) + " %";
}
