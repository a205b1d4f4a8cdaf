// The files of what is seen: a drawing, and the numbers of a figure.

function save(plot, text, type, ending) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = plot.element.id + ending;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
function saveSvg(plot) {
  const copy = plot.svg.cloneNode(true);
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("class", "plot");  // a file is for any screen
  for (const odd of copy.querySelectorAll(".cursor, .off")) odd.remove();
  const style = document.createElementNS("http://www.w3.org/2000/svg", "style");
  style.textContent = document.querySelector("style").textContent;
  copy.prepend(style);
  save(plot, new XMLSerializer().serializeToString(copy), "image/svg+xml", ".svg");
}
function saveCsv(plot) {
  const quoted = (text) => (/[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text);
  const keys = ["x", "y", "low", "high", "time"];
  const all = plot.series.map((series, index) => plot.loaded(index));
  const used = keys.filter((key) => all.some((series) => series[key]));
  const headings = { x: plot.figure.x.heading, y: plot.figure.y.heading, low: "low", high: "high", time: "time [s]" };
  const rows = [["series", ...used.map((key) => headings[key]), "note"].map(quoted).join(",")];
  for (const series of all) {
    const length = Math.max(...used.map((key) => (series[key] ? series[key].length : 0)));
    for (let i = 0; i < length; i += 1) {
      const cells = used.map((key) => (series[key] && Number.isFinite(series[key][i]) ? String(series[key][i]) : ""));
      const note = series.note && series.note[i] >= 0 ? series.notes[series.note[i]] : "";
      rows.push([quoted(series.name), ...cells, quoted(note)].join(","));
    }
  }
  save(plot, rows.join("\n") + "\n", "text/csv", ".csv");
}
