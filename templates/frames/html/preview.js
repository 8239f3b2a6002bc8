"use strict";
// The pages of the PDF that was made last: first the one that has changed.
const preview = (() => {
  const box = document.getElementById("preview"), words = JSON.parse(document.getElementById("live").textContent).words.preview;
  const picture = box.querySelector("img"), link = box.querySelector("a"), said = box.querySelector("[role=status]"), turns = box.querySelectorAll("[data-turn]");
  let known = { build: 0, pages: 0, changed: 0 }, page = 1;
  const filled = (text) => text.replace("{page}", page).replace("{pages}", known.pages);
  const turn = (to) => {
    page = Math.min(Math.max(to, 1), known.pages);
    link.href = picture.src = `made/page-${known.build}-${page}.svg`;
    picture.alt = filled(words.alt);
    said.textContent = `${filled(words.page)}${page === known.changed && known.build > 1 ? ` (${words.changed})` : ""}`;
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
  const show = (making) => {
    const news = making?.preview;
    if (!news) return;
    const told = document.getElementById("making");
    const again = Object.assign(document.createElement("button"), { type: "button", textContent: words.title });
    again.dataset.preview = "";
    again.addEventListener("click", () => open());
    // A notice that is closed stays so, one that says the same is not written anew.
    if (told.hasChildNodes() && !told.querySelector("[data-preview]")) told.append(" ", again);
    if (news.build === known.build) return;
    const first = !known.build;
    known = news;
    open(news.changed || (first ? 1 : page));
  };
  document.addEventListener("news", ({ detail }) => show(detail.making));
  return { open };
})();
