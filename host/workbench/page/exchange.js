// Questions to the program behind the page.

async function told(response) {
  const answer = await response.json().catch(() => ({ error: response.status === 403 ? "This page has expired: open the address that axistool serve printed." : "The program's answer cannot be read." }));
  if (response.ok) return answer;
  throw Object.assign(new Error(answer.error || "Refused (" + response.status + ")."), { log: answer.log });
}

async function reached(promise) {
  try {
    return await promise;
  } catch (error) {
    throw new Error("axistool serve does not answer: is it still running?", { cause: error });
  }
}

/** @param {string} path */
export async function get(path) {
  return told(await reached(fetch(path)));
}

/**
 * @param {string} path
 * @param {any} document
 */
export async function post(path, document) {
  return told(await reached(fetch(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(document) })));
}

/**
 * @param {File} file
 * @returns {Promise<{name: string}>}
 */
export async function upload(file) {
  return told(await reached(fetch("/api/files?name=" + encodeURIComponent(file.name), { method: "POST", body: file })));
}

/** @param {string} name */
export function fileAddress(name) {
  return "/api/file?name=" + encodeURIComponent(name);
}

/**
 * A report of the folder as text.
 * @param {string} name
 */
export async function report(name) {
  const response = await reached(fetch(fileAddress(name)));
  if (!response.ok) await told(response);
  return response.text();
}
