"use strict";
// A kind is chosen: its file is begun, and the page is that of its form.  Schemes come one after the other.
(async () => {
  const buttons = [...document.querySelectorAll("[data-kind]")];
  for (const button of buttons) {
    button.addEventListener("click", async () => {
      buttons.forEach((one) => { one.disabled = true; });
      await fetch("begin.json", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ kind: button.dataset.kind }) });
      // The form begins at its top, wherever the button was.
      scrollTo({ top: 0, behavior: "instant" });
      location.reload();
    });
  }
  for (const button of buttons) {
    const { body, rules } = await (await fetch(`scheme-${button.dataset.kind}.json`)).json();
    if (!body) continue;
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(rules);
    document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
    button.querySelector(".scheme").innerHTML = body;
  }
})().catch(() => { /* another page is there */ });
