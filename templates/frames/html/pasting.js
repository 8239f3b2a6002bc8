"use strict";
// Numbers of pasted cells, with commas or points as decimal marks: what they mean by all of them together.  Signs and
// blanks are those of `base/typed_characters.py`.
const pasting = (() => {
  const NUMBER = /^([+-]?)(\d+(?:[.,]\d+)*)(?![.,\d])(.*)$/, PAIR = /^[+-]?\d+,\d+$/;
  const MINUS = /^[\u2010-\u2012\u2212\ufe63\uff0d](?=[\d.,])/, UNSEEN = /[\u00ad\u200b-\u200f\u2060-\u2064\ufeff]/g;
  const thousands = (blank) => new RegExp(`^([+-]?)([1-9]\\d{0,2}(?:${blank}\\d{3})+)(?!\\d)(.*)$`);
  const WIDE = thousands("[\\u00a0\\u2002-\\u200a\\u202f\\u205f\\u3000]"), BLANK = thousands(" ");
  const rows = (text) => text.replace(/\r/g, "").replace(/\n+$/, "").split("\n").map((line) => line.split("\t").map(plainly));
  const joined = (cell, pattern) => cell.replace(pattern, (_, sign, digits, rest) => sign + digits.replace(/\D/g, "") + rest);
  // A blank that keeps the digits of a number together divides none.
  const signed = (cell) => cell.trim().replace(UNSEEN, "").replace(MINUS, "-"), plainly = (cell) => joined(signed(cell), WIDE);
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
  // A number that has two readings: its text, and by reading what it would be and as what all is pasted.
  const byDecimal = (cells, number) => ({ text: number, means: Object.fromEntries([",", "."].map((decimal) => [decimal, { shown: plain(number, decimal), cells, decimal }])) });
  const written = (cells) => cells.map((line) => line.join("\t")).join("\n");
  const each = (cells, change) => written(cells.map((line) => line.map(change)));
  const doubtOf = (cells, text) => {
    const [[first]] = cells, blank = cells.flat().find((one) => BLANK.test(one));
    // 2,4 alone may be a number or two.
    if (!/[\t\n]/.test(text) && PAIR.test(signed(text))) {
      const [, sign, digits] = NUMBER.exec(first), { means } = byDecimal(first, digits), two = first.replace(",", "\t");
      if (!grouped(digits, ",")) delete means["."];
      for (const one of Object.values(means)) one.shown = sign + one.shown;
      return { text: first, means: { ...means, two: { shown: first.replace(",", ", "), cells: two } } };
    }
    if (!blank) return null;
    const divided = (one) => (BLANK.test(one) ? one.replace(/ (?=\d)/g, "\t") : one);
    return { text: blank, means: {
      one: { shown: joined(blank, BLANK), cells: each(cells, (one) => joined(one, BLANK)) },
      two: { shown: divided(blank).replace(/\t/g, ", "), cells: each(cells, divided) },
    } };
  };
  // One question for all that is pasted, with a button for each reading.
  const question = (doubt, words) => {
    const element = document.createElement("p");
    element.className = "conflict";
    element.setAttribute("role", "alert");
    element.textContent = words.doubt.replace("{text}", doubt.text);
    for (const [reading, { shown }] of Object.entries(doubt.means)) {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: `${words.use} ${doubt.text} = ${shown}` });
      button.dataset.reading = reading;
      element.append(" ", button);
    }
    return element;
  };
  return {
    question,
    // Whether a text is more than a piece of what is typed: cells, or in a `list` a number with a comma or blanks.
    isCells: (text, list) => /[\t\n]/.test(text) || list && (PAIR.test(signed(text)) || plainly(text) !== text.trim()),
    // The cells of a text; `turned` if a comma became a point.  Without a `decimal`, a number that has two readings beside
    // the others is `doubt`.
    read: (text, decimal = "") => {
      const cells = rows(text), all = cells.flat().map((one) => NUMBER.exec(one)?.[2]).filter(Boolean);
      const commas = all.some(isComma), someComma = all.some((one) => one.includes(","));
      // 1,200 beside 0,5 is 1.2, but 1.200 beside 0,5 may be 1200 or, typed by hand, 1.2.
      const single = (one, mark) => marks(one).length === 1 && grouped(one, mark);
      const asked = all.find((one) => someComma && single(one, ".") || !commas && single(one, ","));
      const doubt = decimal ? null : doubtOf(cells, text) || (asked ? byDecimal(text, asked) : null);
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
