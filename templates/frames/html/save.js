"use strict";
// Saves a drawing as it stands, in light colours and with its own looks: as SVG, or as PNG of 300 dots an inch.
(() => {
  const LOOKS = "fill stroke stroke-width stroke-dasharray paint-order font-family font-size font-style text-anchor".split(" ");
  const all = (one) => [one, ...one.querySelectorAll("*")];
  const text = (svg) => {
    const { dataset } = document.documentElement, { theme } = dataset, copy = svg.cloneNode(true), copies = all(copy);
    dataset.theme = "light";
    all(svg).forEach((one, index) => {
      const look = getComputedStyle(one);
      if (look.display === "none" || one.matches(".spot")) copies[index].remove();
      copies[index].removeAttribute("class");
      for (const name of LOOKS) copies[index].setAttribute(name, look.getPropertyValue(name));
    });
    if (theme) dataset.theme = theme; else delete dataset.theme;
    return new XMLSerializer().serializeToString(copy);
  };
  const save = (name, blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
  };
  const makers = {
    svg: (svg, put) => put(new Blob([text(svg)])),
    png: async (svg, put) => {
      const image = new Image(), canvas = document.createElement("canvas"), pen = canvas.getContext("2d");
      image.src = `data:image/svg+xml,${encodeURIComponent(text(svg))}`;
      await image.decode();
      for (const side of ["width", "height"]) canvas[side] = parseFloat(svg.getAttribute(side)) * 300 / 25.4;
      pen.fillStyle = "#fff";
      pen.fillRect(0, 0, canvas.width, canvas.height);
      pen.drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob(put);
    },
  };
  document.addEventListener("click", ({ target }) => {
    const kind = target.dataset?.save, row = kind && target.parentElement;
    if (row) makers[kind](row.previousElementSibling, (blob) => save(`${row.dataset.name}.${kind}`, blob));
  });
})();
