"use strict";
// The pages of the PDF that was made last: first the one that has changed.
const preview = (() => {
  const box = document.getElementById("preview"), words = JSON.parse(document.getElementById("live").textContent).words.preview;
  const picture = box.querySelector("img"), link = box.querySelector("a"), place = box.querySelector("[role=status]"), turns = box.querySelectorAll("[data-turn]");
  let known = { build: 0, pages: 0, changed: 0 }, page = 1;
  const filled = (text) => text.replace("{page}", page).replace("{pages}", known.pages);
  const turn = (to) => {
    page = Math.min(Math.max(to, 1), known.pages);
    link.href = picture.src = `made/page-${known.build}-${page}.svg`;
    picture.alt = filled(words.alt);
    place.textContent = `${filled(words.page)}${page === known.changed && known.build > 1 ? ` (${words.changed})` : ""}`;
    turns.forEach((button) => { button.disabled = page + Number(button.dataset.turn) < 1 || page + Number(button.dataset.turn) > known.pages; });
  };
  const open = (to = page) => {
    if (!known.pages) return false;
    box.hidden = false;
    turn(to);
    return true;
  };
  box.addEventListener("click", ({ target }) => {
    const { dataset } = target;
    if ("turn" in dataset) turn(page + Number(dataset.turn));
    if (!("close" in dataset)) return;
    box.hidden = true;
    document.querySelector("#making [data-preview]")?.focus();
  });
  const show = (making, old) => {
    const news = making?.preview, said = document.getElementById("making");
    if (!news) return;
    if (said.hasChildNodes() && !said.querySelector("[data-preview]")) {
      const again = Object.assign(document.createElement("button"), { type: "button", textContent: words.title });
      again.dataset.preview = "";
      again.addEventListener("click", () => open());
      said.append(" ", again);
    }
    if (news.build === known.build) return;
    const first = !known.build;
    known = news;
    // What was made before the page was loaded is not shown again.
    if (!old) open(news.changed || (first ? 1 : page));
  };
  let loaded = false;
  document.addEventListener("news", ({ detail }) => {
    show(detail.making, !loaded);
    loaded = true;
  });
  // The page of a heading of the report; false without a PDF.
  return { openHeading: (heading) => Boolean(known.headings?.[heading - 1]) && open(known.headings[heading - 1]) };
})();
