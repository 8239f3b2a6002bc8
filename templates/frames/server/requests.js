// Requests of a page to its own server, with the token that proves that the page itself sends them.

const data = (id) => JSON.parse(document.getElementById(id)?.textContent || "null");
export const words = data("words") ?? {}, errors = data("errors") ?? {};
export { data };

const language = document.documentElement.lang;
export const fill = (text, values) => text.replace(/\{(\w+)\}/g, (whole, name) => values[name] ?? whole);
// Times are shown at the server's own offset, as on the rest of the page.
export const moment = (text) => {
  const [, year, month, day, time] = /^(\d+)-(\d+)-(\d+)T(\d+:\d+)/.exec(text ?? "") ?? [];
  return !year ? "" : language === "vi" ? `${time}, ${day}/${month}/${year}` : `${year}-${month}-${day}, ${time}`;
};
export const clock = () => new Date().toLocaleTimeString("vi", { hour: "2-digit", minute: "2-digit" });
export const number = (value) => (value === null || value === undefined ? "–" : value.toLocaleString(language, { maximumFractionDigits: 4 }));

// Works without a secure context, which `crypto.randomUUID` needs.
export const newId = () =>
  [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, "0")).join("");

const AGAIN = new Set([408, 413, 429, 500, 502, 503, 504, 507]);

// An answer that is an error. `again`: the same request may succeed later.
export class Refused extends Error {
  constructor(status, answer) {
    super([answer.message || errors[answer.error] || words.refused, ...(answer.lines ?? [])].join(" "));
    this.status = status;
    this.again = AGAIN.has(status);
  }
}

// Return the answer. Throws `Refused` for an error, and an `Error` with `again` if the server cannot be reached.
export async function send(path, body, patience = 20000) {
  const form = body instanceof FormData;
  const headers = { "X-CSRF-Token": document.querySelector('meta[name="csrf"]').content, Accept: "application/json" };
  if (body && !form) headers["Content-Type"] = "application/json";
  let answer, content;
  try {
    answer = await fetch(path, {
      method: body ? "POST" : "GET",
      headers,
      body: form ? body : body && JSON.stringify(body),
      credentials: "same-origin",
      redirect: "error",
      signal: AbortSignal.timeout(patience),
    });
    content = await answer.json();
  } catch (error) {
    if (answer && !answer.ok) throw new Refused(answer.status, {});
    throw Object.assign(new Error(words.unreachable), { again: true });
  }
  if (!answer.ok) throw new Refused(answer.status, content);
  return content;
}

// Return an element with a text or children; `attributes` are its properties.
export function element(name, content = [], attributes = {}) {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...(Array.isArray(content) ? content : [String(content)]));
  return made;
}

export const size = (count) => (count >= 1e6 ? `${(count / 1e6).toFixed(1)} MB` : `${Math.max(count / 1e3, 0.1).toFixed(1)} kB`);
