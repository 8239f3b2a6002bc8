"use strict";
// Rows of one length side by side as a grid, with a curve of each over the first.  A cell is a field as any other, its
// place one in the list of its column.
const tables = (() => {
  const MOST_ROWS = 400;
  const words = JSON.parse(document.getElementById("live").textContent).words;
  const values = (input) => (/[\[{"']/.test(input.value) || !input.value.trim() ? [] : input.value.replace(/,\s*$/, "").split(",").map((one) => one.trim()));
  const label = (input) => input.closest(".field").querySelector("label").textContent;
  const node = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  const curve = (columns) => {
    const numbers = columns.map((column) => column.map((one) => parseFloat(one)));
    const [x, ...ys] = numbers, all = ys.flat(), low = Math.min(...all, 0), high = Math.max(...all, low + 1e-9);
    const across = (at) => 4 + 192 * (at - x[0]) / (x[x.length - 1] - x[0] || 1), up = (at) => 76 - 72 * (at - low) / (high - low);
    const lines = ys.map((y) => `M${y.map((at, index) => `${across(x[index])} ${up(at)}`).join("L")}`);
    if (numbers.flat().some((one) => !isFinite(one))) return "";
    const dashes = ["", "5 2", "1.5 1.5", "6 2 1 2"];
    return `<svg viewBox="0 0 200 80" aria-hidden="true"><path d="M4 ${up(0)}H196"/>${lines.map((d, index) => `<path class="curve" stroke-dasharray="${dashes[index % 4]}" d="${d}"/>`).join("")}</svg>`;
  };
  const cell = (input, value, row, column) => {
    const element = node("input", { autocomplete: "off" });
    element.setAttribute("value", value);
    element.setAttribute("aria-label", `${label(input)} ${row + 1}`);
    Object.assign(element.dataset, { w: JSON.stringify([...JSON.parse(input.dataset.w), row]), was: value, row, column });
    return node("td", {}, element);
  };
  const grid = (inputs) => {
    const columns = inputs.map(values);
    const body = columns[0].map((_, row) => node("tr", {}, ...columns.map((column, index) => cell(inputs[index], column[row], row, index))));
    const head = node("tr", {}, ...inputs.map((input) => node("th", { scope: "col", textContent: JSON.parse(input.dataset.w).at(-1) })));
    const box = node("div", { className: "grid", tabIndex: 0 }, node("table", {}, node("thead", {}, head), node("tbody", {}, ...body)));
    box.setAttribute("role", "group");
    box.setAttribute("aria-label", words.table);
    const outer = node("details", { className: "tabled" }, node("summary", { textContent: words.table }), box);
    Object.assign(outer.dataset, { open: `table ${inputs[0].id}`, columns: JSON.stringify(inputs.map((input) => input.id)) });
    outer.insertAdjacentHTML("beforeend", curve(columns));
    inputs[inputs.length - 1].closest(".field").after(outer);
  };
  // A single value is changed in its place; a row of another length is written anew.
  const changed = (input, next) => {
    const old = values(input), others = next.flatMap((one, index) => (one === old[index] ? [] : [index])), [at] = others;
    if (!others.length) return null;
    if (old.length !== next.length || others.length > 1) return [input.dataset.w, next.join(", "), input.dataset.was];
    return [JSON.stringify([...JSON.parse(input.dataset.w), at]), next[at], old[at]];
  };
  // A number as it may stand in a cell: what stands before its digits, these, its unit.
  const unit = (text, typed) => { const parts = typed(text || ""); return parts ? parts.unit.trim() : ""; };
  return {
    // The grids of a form that is not shown yet.
    grids: (form) => {
      const alike = new Map();
      for (const input of form.querySelectorAll("input[data-list]")) {
        const length = values(input).length, key = JSON.stringify([JSON.parse(input.dataset.w).slice(0, -1), length]);
        if (length > 2 && length <= MOST_ROWS) alike.set(key, [...(alike.get(key) || []), input]);
      }
      for (const inputs of alike.values()) if (inputs.length > 1) grid(inputs);
    },
    // From cell to cell by keys; returns whether the key was one of those.
    go: (event) => {
      const { row, column } = event.target.dataset, { selectionStart: at, value } = event.target;
      const down = { ArrowUp: -1, ArrowDown: 1, Enter: 1 }[event.key] || 0;
      const side = event.key === "ArrowLeft" && at === 0 ? -1 : event.key === "ArrowRight" && at === value.length ? 1 : 0;
      if (!down && !side) return false;
      const table = event.target.closest("table");
      table.querySelector(`[data-row="${Number(row) + down}"][data-column="${Number(column) + side}"]`)?.focus();
      return true;
    },
    // What is pasted from a workbook: cells by rows, a unit where the column has one.
    // Returns what changes, [place, new text, old text] each, and what is to be said.
    pasted: ({ cells, turned }, target, typed) => {
      const inputs = JSON.parse(target.closest(".tabled").dataset.columns).map((id) => document.getElementById(id));
      const columns = inputs.map(values), from = Number(target.dataset.row), first = Number(target.dataset.column);
      cells.forEach((line, index) => line.forEach((one, offset) => {
        const column = columns[first + offset];
        if (!column) return;
        let value = one;
        const parts = typed(value), own = unit(columns[first + offset][0], typed);
        if (parts && !parts.over && !parts.unit.trim() && own) value = `${value} ${own}`;
        for (const other of columns) other[from + index] ??= "0";
        column[from + index] = value;
      }));
      const most = Math.min(...inputs.map((input) => Number(input.dataset.list) || Infinity)), count = columns[0].length;
      if (count > most) return { changes: [], said: words.many_rows.replace("{count}", count).replace("{most}", most) };
      return { changes: inputs.map((input, index) => changed(input, columns[index])).filter(Boolean), said: turned ? words.commas : "" };
    },
  };
})();
