"use strict";
// A key that is missing: its button leads to the field, and adds what the field stands in. Names that the user chooses.
(() => {
  const { byPlace, reach, build } = fields, form = document.getElementById("fields"), FIELD = "input[data-was], select[data-was]";
  const then = (where) => ({ refused }) => { if (!refused) setTimeout(() => lead(where, false)); };
  const lead = (where, add = true) => {
    const place = [...where];
    while (place.length && !byPlace(place)) place.pop();
    const target = byPlace(place), field = target?.matches(FIELD) ? target : target?.querySelector(FIELD);
    if (field) reach(field);
    else if (target?.querySelector("[data-name]")) reach(target.querySelector("[data-loose]"));
    else if (target?.querySelector("[data-add]") && add) build(() => ({ op: "add", where: place }), then(where));
  };
  form.addEventListener("click", ({ target }) => {
    const button = target.closest("button");
    if (!button) return;
    if ("want" in button.dataset) lead(JSON.parse(button.dataset.want));
    else if ("name" in button.dataset) {
      const name = button.parentElement.querySelector("[data-loose]"), group = JSON.parse(button.closest("[data-w]").dataset.w);
      const body = { op: "add", where: group, name: name.value.trim(), table: button.dataset.name === "table" };
      if (body.name) build(() => body, then([...group, body.name]));
    } else if ("rename" in button.dataset) {
      const where = JSON.parse((button.closest(".box")?.querySelector("[data-w]") ?? button.closest("[data-w]")).dataset.w);
      const name = button.previousElementSibling.value.trim();
      if (name && name !== where.at(-1)) build(() => ({ op: "rename", where, name }), then([...where.slice(0, -1), name]));
    }
  });
})();
