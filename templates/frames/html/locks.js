"use strict";
// A padlock at each value that may follow a pulled point or load: a locked one stays, and another value follows.  Locks are known
// to the browser alone.
const locks = (() => {
  const KEEP = `reportgen-locks${location.pathname}`, form = document.getElementById("fields");
  const words = JSON.parse(document.getElementById("live").textContent).words;
  let places = [], locked = new Set();
  try { locked = new Set(JSON.parse(sessionStorage.getItem(KEEP)) || []); } catch { /* no memory */ }

  // A list has one field for several values, which are numbered.
  const put = (root) => {
    const inputs = new Map([...root.querySelectorAll("input[data-was]")].map((input) => [JSON.stringify(JSON.parse(input.dataset.w)), input]));
    for (const where of places) {
      const key = JSON.stringify(where), single = inputs.get(key), input = single || inputs.get(JSON.stringify(where.slice(0, -1)));
      if (!input || [...root.querySelectorAll(".lock")].some((one) => one.dataset.lock === key)) continue;
      const number = single ? "" : String(where.at(-1) + 1), button = document.createElement("button");
      Object.assign(button, { type: "button", className: "small lock", title: words.lock });
      Object.assign(button.dataset, { lock: key, key: `lock:${key}` });
      button.setAttribute("aria-label", `${words.lock}: ${input.closest(".field").querySelector("label").textContent} ${number}`.trim());
      button.setAttribute("aria-pressed", locked.has(key));
      button.innerHTML = `<svg viewBox="0 0 16 16" aria-hidden="true"><path class="bow" d="M5 7V4.5a3 3 0 0 1 6 0V7"/><path class="body" d="M3 7h10v7H3z"/></svg>${number}`;
      const box = input.closest(".box"), last = [...box.querySelectorAll(".lock")].at(-1);
      (last || input).after(button);
    }
  };
  form.addEventListener("click", ({ target }) => {
    const button = target.closest(".lock");
    if (!button) return;
    const { lock } = button.dataset;
    if (!locked.delete(lock)) locked.add(lock);
    button.setAttribute("aria-pressed", locked.has(lock));
    try { sessionStorage.setItem(KEEP, JSON.stringify([...locked])); } catch { /* no memory */ }
  });
  document.addEventListener("forming", ({ detail }) => put(detail));
  document.addEventListener("gripped", ({ detail }) => {
    const lists = [...Object.values(detail.points), ...Object.values(detail.loads)];
    places = [...new Map(lists.flat().map((where) => [JSON.stringify(where), where])).values()];
    put(form);
    fields.keep();
  });
  return { places: () => [...locked].map((key) => JSON.parse(key)) };
})();
