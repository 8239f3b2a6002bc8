"use strict";
// A kind or a sample is chosen: its file is begun, and the page becomes that of its form.  Cards are found by what is
// typed, whatever its accents.
(() => {
  const words = JSON.parse(document.getElementById("live").textContent).words;
  const buttons = [...document.querySelectorAll("[data-kind]")], search = document.getElementById("search");
  const told = document.getElementById("told"), found = document.getElementById("found");

  // There is nothing else on the page: the report is still empty.
  document.getElementById("form").setAttribute("role", "main");

  // Letters without accents; what is left of Vietnamese is the bar of đ.
  const plain = (text) => text.toLowerCase().normalize("NFD").replace(/\p{M}/gu, "").replaceAll("đ", "d");
  const cut = (text) => plain(text).split(/[^\p{L}\p{N}]+/u).filter(Boolean);
  // A word is found by its beginning; where words are not parted by blanks, by any piece.
  const fits = (asked, terms) => asked.every((word) => terms.some((term) => term.startsWith(word) || /[^\x00-\u052f]/.test(word) && term.includes(word)));
  const cards = [...document.querySelectorAll(".card")].map((card) => ({
    card,
    terms: cut(`${card.dataset.terms} ${card.firstElementChild.textContent}`),
    samples: [...card.querySelectorAll("[data-sample]")].map((sample) => ({ sample, terms: cut(sample.textContent) })),
  }));
  const find = () => {
    const asked = cut(search.value), named = cards.some(({ terms }) => fits(asked, terms));
    let count = 0;
    // Samples are found where no kind is.
    for (const { card, terms, samples } of cards) {
      const whole = fits(asked, terms), some = named ? [] : samples.filter((one) => fits(asked, [...terms, ...one.terms]));
      card.hidden = !whole && !some.length;
      for (const { sample } of samples) sample.parentElement.hidden = !whole && !some.some((one) => one.sample === sample);
      const box = card.querySelector("details");
      if (box) box.open = asked.length > 0 && !whole;
      if (!card.hidden) count += 1;
    }
    for (const group of document.querySelectorAll(".group")) group.hidden = !group.querySelector(".card:not([hidden])");
    found.textContent = !asked.length ? "" : count ? words.matches.replace("{count}", count) : words.nothing;
  };
  search.addEventListener("input", find);
  search.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && !event.isComposing) document.querySelector(".card:not([hidden]) > button")?.focus();
  });
  // A browser may fill in what was typed before the page was loaded anew.
  if (search.value) find();

  // The answer to a message, or nothing if it was refused.
  const ask = async (name, message, lost = {}) => {
    try {
      const answer = await fetch(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(message) });
      return answer.ok ? await answer.json() : {};
    } catch {
      return lost;
    }
  };
  const begin = ({ dataset: { kind, sample } }) => ask("begin.json", { kind, ...(sample ? { sample } : {}) }, { refused: words.lost });

  // A machine of the user's folder is drawn when its card comes into view, one after another.
  const draw = async (place) => {
    const { box, rules, elements } = await ask("scheme.json", { kind: place.closest("[data-kind]").dataset.kind });
    if (!elements) return;
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(rules);
    document.adoptedStyleSheets.push(sheet);
    place.innerHTML = `<svg aria-hidden="true" viewBox="${box}">${elements}</svg>`;
  };
  let drawn = Promise.resolve();
  const seen = new IntersectionObserver((places) => {
    for (const { isIntersecting, target } of places) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      drawn = drawn.then(() => draw(target));
    }
  }, { rootMargin: "200px" });
  for (const place of document.querySelectorAll(".scheme:empty")) seen.observe(place);

  for (const button of buttons) {
    button.addEventListener("click", async () => {
      buttons.forEach((one) => { one.disabled = true; });
      told.textContent = "";
      found.textContent = words.begins;
      const { refused } = await begin(button);
      if (!refused) {
        // The form begins at its top, wherever the button was.
        history.scrollRestoration = "manual";
        scrollTo({ top: 0, behavior: "instant" });
        location.reload();
        return;
      }
      buttons.forEach((one) => { one.disabled = false; });
      found.textContent = "";
      told.textContent = refused;
      told.scrollIntoView({ block: "nearest" });
      button.focus({ preventScroll: true });
    });
  }
})();
