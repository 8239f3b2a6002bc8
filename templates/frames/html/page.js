"use strict";
// What every page has: the choice of light or dark, and keys that reach what scrolls in itself.
(() => {
  const choice = document.getElementById("theme");
  const remembered = () => { try { return localStorage.getItem("theme") || ""; } catch { return ""; } };
  const show = (theme) => {
    if (theme) document.documentElement.dataset.theme = theme;
    else delete document.documentElement.dataset.theme;
  };
  choice.value = remembered();
  show(choice.value);
  choice.addEventListener("change", () => {
    show(choice.value);
    try { localStorage.setItem("theme", choice.value); } catch { /* a page from a disk may have no memory */ }
  });

  // What is wider than its place can be scrolled by keys, and says so; the rest is no stop on the way.
  const reach = (box) => {
    if (box.scrollWidth > box.clientWidth + 1) {
      box.tabIndex = 0;
    } else {
      box.removeAttribute("tabindex");
    }
  };
  const boxes = () => document.querySelectorAll(".scroll, .aligned > div > *").forEach(reach);
  let waiting = 0;
  const later = () => { cancelAnimationFrame(waiting); waiting = requestAnimationFrame(boxes); };
  addEventListener("resize", later);
  addEventListener("load", later);
  document.addEventListener("renewed", later);
  later();
})();
