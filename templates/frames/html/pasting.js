"use strict";
// Numbers of pasted cells, with commas or points as decimal marks: what they mean by all of them together.
const pasting = (() => {
  const NUMBER = /^([+-]?)(\d+(?:[.,]\d+)*)(?![.,\d])(.*)$/;
  const rows = (text) => text.replace(/\r/g, "").replace(/\n+$/, "").split("\n").map((line) => line.split("\t").map((one) => one.trim()));
  // Groups of three digits may be thousands; in 1.234,5 and 1.234.567 they are.
  const grouped = (digits, mark) => new RegExp(`^[1-9]\\d{0,2}(?:\\${mark}\\d{3})+$`).test(digits);
  const marks = (digits) => [...digits].filter((one) => one === "." || one === ",");
  const isComma = (digits) => {
    const list = marks(digits), last = list.at(-1);
    return last === "," && list.filter((one) => one === ",").length === 1 && !grouped(digits, ",");
  };
  const isPoint = (digits) => {
    const list = marks(digits), last = list.at(-1);
    return last === "." && list.filter((one) => one === ".").length === 1 && !grouped(digits, ".");
  };
  const plain = (digits, decimal) => {
    const other = decimal === "," ? "." : ",";
    const next = digits.split(other).join("").replace(",", ".");
    // 1.20 has one reading, 1.200 has two for the program.
    return next.includes(".") && grouped(digits, decimal) ? next.replace(/\.?0+$/, "") : next;
  };
  // One question for all that is pasted, with a button for each reading.
  const question = (doubt, words) => {
    const element = document.createElement("p");
    element.className = "conflict";
    element.setAttribute("role", "alert");
    element.textContent = words.doubt.replace("{text}", doubt.text);
    for (const reading of [",", "."]) {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: `${words.use} ${doubt.text} = ${doubt[reading]}` });
      button.dataset.reading = reading;
      element.append(" ", button);
    }
    return element;
  };
  return {
    question,
    // The cells of a text; `turned` if a comma became a point.  Without a `decimal`, a number that has two readings beside
    // the others is `doubt`: the text, and by decimal mark what it would be.
    read: (text, decimal = "") => {
      const cells = rows(text), all = cells.flat().map((one) => NUMBER.exec(one)?.[2]).filter(Boolean);
      const commas = all.some(isComma), someComma = all.some((one) => one.includes(","));
      // 1,200 beside 0,5 is 1.2, but 1.200 beside 0,5 may be 1200 or, typed by hand, 1.2.
      const single = (one, mark) => marks(one).length === 1 && grouped(one, mark);
      const asked = all.find((one) => someComma && single(one, ".") || !commas && single(one, ","));
      const doubt = asked && !decimal ? { text: asked, ",": plain(asked, ","), ".": plain(asked, ".") } : null;
      let turned = false;
      const meant = (digits) => {
        const list = marks(digits);
        if (list.length > 1) return isComma(digits) ? plain(digits, ",") : isPoint(digits) ? plain(digits, ".") : grouped(digits, list[0]) ? digits.split(list[0]).join("") : digits;
        if (!list.length || !someComma) return digits;
        return plain(digits, grouped(digits, list[0]) ? decimal || list[0] : list[0]);
      };
      const value = (one) => {
        const [, sign, digits, rest] = NUMBER.exec(one) || [], next = digits ? sign + meant(digits) + rest : one;
        if (next !== one) turned = true;
        return next;
      };
      return { cells: cells.map((line) => line.map(value)), turned, doubt };
    },
  };
})();
