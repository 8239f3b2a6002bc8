"use strict";
// While a point is pulled, the places at which the machine still assembles and turns are shaded beneath it: roughly at
// once, then finely.
(() => {
  if (typeof pulls === "undefined" || !pulls) return;
  const COARSE = 8, FINE = 24;
  let current = null, searched = "";

  const shade = ({ path, lines }) => {
    let shape = pulls.svg().querySelector(".region");
    if (!shape) pulls.svg().prepend(shape = pulls.element("path", { class: "region beneath" }));
    shape.classList.toggle("line", lines);
    shape.setAttribute("d", path);
  };
  // In millimetres of the drawing of the machine that is shown: a renewed one may have another scale.
  const find = async (detail) => {
    const of = searched = document.body.dataset.moving;
    try {
      for (const count of [COARSE, FINE]) {
        const found = await (await post("region.json", { ...detail, count })).json();
        if (current !== detail || searched !== of || found.path === undefined) return;
        shade(found);
      }
    } catch { /* the server tells of itself */ }
  };
  document.addEventListener("pull", ({ detail }) => {
    const ended = current;
    current = detail;
    if (detail) { find(detail); return; }
    pulls.svg().querySelector(".region")?.remove();
    if (ended) post("released.json", { grab: ended.grab }).catch(() => {});
  });
  document.addEventListener("showing", () => {
    if (current && searched !== document.body.dataset.moving) find(current);
  });
})();
