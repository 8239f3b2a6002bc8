// Rules of style that change with the machine and the report.  They are there before any script measures a letter.
const looks = (() => {
  const sheets = { moving: new CSSStyleSheet(), report: new CSSStyleSheet() }, known = {};
  document.adoptedStyleSheets = Object.values(sheets);
  // Other rules have the whole page laid out anew, which takes longer than all the rest: the same are left.
  const rule = (part, rules) => {
    if (known[part] !== rules) sheets[part].replaceSync(rules);
    known[part] = rules;
  };
  const { rules } = JSON.parse(document.getElementById("live").textContent);
  for (const [part, given] of Object.entries(rules)) rule(part, given);
  return { rule };
})();
