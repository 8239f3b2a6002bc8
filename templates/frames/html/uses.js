"use strict";
// Where the report uses a value: asked for on request, shown below its field.  A line leads to the page of the PDF that
// was made last, else to its section in the report.
(() => {
  const form = document.getElementById("fields"), report = document.getElementById("report"), words = JSON.parse(document.getElementById("live").textContent).words.uses;
  let box = null;
  const node = (name, properties, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  };
  const lead = ({ heading, number }) => {
    if (preview.openHeading(heading)) return;
    const place = number && [...report.querySelectorAll("h1, h2, h3, h4")].find((title) => title.querySelector(".n")?.textContent === number);
    place?.scrollIntoView();
  };
  const close = () => {
    box?.remove();
    box = null;
  };
  const show = (button, id, { lines, following }) => {
    const sections = lines.reduce((all, line) => all.set(line.heading, [...(all.get(line.heading) || []), line]), new Map());
    const list = node("ul", {}, ...[...sections.values()].map((own) => {
      const line = own[0], symbols = own.map(({ symbol }) => symbol).join(", ");
      const go = node("button", { type: "button", textContent: `${line.number} ${line.title}: ${symbols}`.trim() });
      go.addEventListener("click", () => lead(line));
      return node("li", {}, go);
    }));
    const end = node("button", { type: "button", className: "small", textContent: words.close });
    end.addEventListener("click", () => {
      close();
      // The button is hidden while its field is not used.
      document.getElementById(id)?.focus();
    });
    close();
    // Not within the fields, which are made anew with each change.
    box = node("div", { id: "uses" }, node("h2", { textContent: button.getAttribute("aria-label") }), lines.length ? list : node("p", { textContent: words.none }),
      node("p", { textContent: words.following.replace("{count}", following) }), end);
    box.setAttribute("role", "region");
    box.setAttribute("aria-label", button.getAttribute("aria-label"));
    form.after(box);
    box.tabIndex = -1;
    box.focus();
  };
  form.addEventListener("click", async ({ target }) => {
    const button = target.closest("[data-uses]");
    if (!button) return;
    const field = button.closest(".field").querySelector("[data-w]"), where = JSON.parse(field.dataset.w);
    const answer = await fetch("uses.json", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ where }) });
    if (answer.ok) show(button, field.id, await answer.json());
  });
})();
