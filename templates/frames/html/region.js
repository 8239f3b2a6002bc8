"use strict";
// While a point is pulled, the places at which the machine still assembles and turns are shaded beneath it: roughly at
// once, then finely.
(() => {
  if (typeof pulls === "undefined" || !pulls) return;
  const COARSE = 8, FINE = 24;
  const post = async (name, body) => (await fetch(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) })).json();
  let current = null, last = null;

  const shade = ({ path, lines }) => {
    let shape = pulls.svg().querySelector(".region");
    if (!shape) pulls.svg().prepend(shape = pulls.element("path", { class: "region beneath" }));
    shape.classList.toggle("line", lines);
    shape.setAttribute("d", path);
  };
  const find = async (detail) => {
    try {
      for (const count of [COARSE, FINE]) {
        const found = await post("region.json", { ...detail, count });
        if (current !== detail || found.path === undefined) return;
        shade(last = found);
      }
    } catch { /* the server tells of itself */ }
  };
  document.addEventListener("pull", ({ detail }) => {
    const ended = current;
    current = detail;
    last = null;
    if (detail) { find(detail); return; }
    pulls.svg().querySelector(".region")?.remove();
    if (ended) post("released.json", { grab: ended.grab }).catch(() => {});
  });
  // The drawing of a renewed machine has none.
  document.addEventListener("showing", () => {
    if (!current || pulls.svg().querySelector(".region")) return;
    if (last) shade(last); else find(current);
  });
})();
