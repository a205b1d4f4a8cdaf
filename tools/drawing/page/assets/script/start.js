// The start of the page.

for (const [id, figure] of Object.entries(data.figures)) plots.push(new Plot(document.getElementById(id), figure));

addEventListener("scroll", () => {
  for (const plot of plots) if (plot.isDue && plot.isInSight()) requestAnimationFrame(() => plot.drawDue());
}, { passive: true });
for (const query of ["(max-width: 599.9px)", "(min-width: 1200px)"])
  matchMedia(query).addEventListener("change", () => plots.forEach((plot) => plot.takeVisible()));
addEventListener("beforeprint", () => {
  for (const plot of plots) {
    plot.take(plot.drawings.usual);
    plot.drawDue();
  }
  for (const folded of document.querySelectorAll("details")) folded.open = true;
});
addEventListener("afterprint", () => plots.forEach((plot) => plot.takeVisible()));
document.documentElement.dataset.ready = String(plots.length);
