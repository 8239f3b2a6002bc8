"use strict";
// A page that follows its file: it is told of each revision, and asks for what is newer than what it shows.
(() => {
  const given = JSON.parse(document.getElementById("live").textContent);
  const fault = document.getElementById("fault"), state = document.getElementById("state");
  const report = document.getElementById("report");
  const shown = { report: given.report, language: document.documentElement.lang };
  // What is told of a machine is of the one with this number.
  const showing = (moving) => {
    document.body.dataset.moving = shown.moving = moving;
    document.dispatchEvent(new Event("showing"));
  };
  showing(given.moving);
  const moves = typeof panels === "undefined" ? [] : panels;

  // After a page is loaded anew it goes on where it was.
  const KEEP = "reportgen" + location.pathname;
  const leave = async () => {
    const until = [];
    document.dispatchEvent(new CustomEvent("leaving", { detail: until }));
    await Promise.all(until);
    try { sessionStorage.setItem(KEEP, JSON.stringify({ scroll: scrollY, angles: moves.map((panel) => panel.angle()) })); } catch { /* no memory */ }
    location.reload();
  };
  try {
    const kept = JSON.parse(sessionStorage.getItem(KEEP) || "null");
    sessionStorage.removeItem(KEEP);
    if (kept) {
      moves.forEach((panel, index) => { if (index in kept.angles) panel.seek(kept.angles[index]); });
      scrollTo(0, kept.scroll);
    }
  } catch { /* no memory */ }

  const PATIENCE = 5000;
  const ask = async (name) => (await fetch(name, { cache: "no-store" })).json();

  // The first place with a name that is in view, and how far below the upper edge it is.
  const anchor = () => {
    const places = [...report.querySelectorAll("[id]")];
    const place = places.find((one) => one.getBoundingClientRect().bottom > 0) || places.at(-1);
    return place && { id: place.id, top: place.getBoundingClientRect().top };
  };

  const renewMoving = async () => {
    const news = await ask("moving.json");
    if (news.panels.length !== moves.length) return;
    // What is being pulled first gets its place on the new machine, so that it does not go back for a moment.
    const until = [];
    document.dispatchEvent(new CustomEvent("renewing", { detail: until }));
    await Promise.race([Promise.all(until), new Promise((done) => setTimeout(done, PATIENCE))]);
    looks.rule("moving", news.rules);
    const place = anchor();
    news.panels.forEach(({ body, data }, index) => moves[index].renew(body, data));
    stay(place);
  };
  const renewReport = async () => {
    const news = await ask("report.json");
    if (!news.body) return;
    const place = anchor(), folded = [...report.querySelectorAll("details")].map((one) => one.open);
    looks.rule("report", news.rules);
    report.innerHTML = news.body;
    document.title = news.title;
    report.querySelectorAll("details").forEach((one, index) => { if (index in folded) one.open = folded[index]; });
    stay(place);
  };
  const stay = (place) => {
    const now = place && document.getElementById(place.id);
    if (now) scrollBy({ top: now.getBoundingClientRect().top - place.top, behavior: "instant" });
    document.dispatchEvent(new Event("renewed"));
  };

  // Whether the panels of a revision, by the names that their ids begin with, are those that the page has.
  const alike = (names) => names.join(" ") === moves.map((panel) => panel.own).join(" ");

  // One after the other: a revision that comes meanwhile is looked at when this one is shown.
  let news = null, working = false;
  const follow = async () => {
    if (working) return;
    working = true;
    try {
      while (news) {
        const now = news;
        news = null;
        const changed = now.reads !== shown.reads;
        shown.reads = now.reads;
        document.dispatchEvent(new CustomEvent("news", { detail: { making: now.making, changed } }));
        fault.hidden = !now.fault;
        fault.lastElementChild.textContent = now.fault;
        // Of a file that was never right there is nothing to show.
        const said = now.moving || now.report ? given.words.fault : given.words.never;
        fault.firstElementChild.textContent = said;
        fault.setAttribute("aria-label", said);
        if (now.language !== shown.language && !now.fault || !alike(now.moves) && !now.fault) { await leave(); return; }
        if (now.moving !== shown.moving) await renewMoving();
        showing(now.moving);
        if (now.report !== shown.report) await renewReport();
        shown.report = now.report;
        state.textContent = now.busy ? given.words.waiting : now.fault ? "" : given.words.ready;
      }
    } finally {
      working = false;
    }
  };
  const channel = new EventSource("news");
  channel.addEventListener("message", (event) => { news = JSON.parse(event.data); follow(); });
  channel.addEventListener("error", () => { state.textContent = given.words.lost; });
})();
