// Grid, tick labels and the scale bar of what is in view.

class Axes {
  constructor(plot) { this.plot = plot; }

  draw() {
    if (this.plot.figure.motion !== "still") this.drawAxes();
    if (this.plot.drawing.ornaments) this.drawScaleBar();
  }
  drawAxes() {
    const { plot } = this;
    const [bottom, box] = [plot.top + plot.height, plot.figure];
    let grid = "";
    let labels = "";
    for (const tick of ticks(...plot.view.x, box.x.log, Math.floor(plot.width / 90) + 1)) {
      const x = px(plot.toX(tick.value));
      grid += "M" + x + " " + px(plot.top) + "v" + px(plot.height);
      labels += `<text class="tick-x" x="${x}" y="${px(bottom + 16)}">${tick.label}</text>`;
    }
    for (const tick of ticks(...plot.view.y, box.y.log, Math.floor(plot.height / 45) + 1)) {
      const y = plot.toY(tick.value);
      grid += "M" + px(plot.left) + " " + px(y) + "h" + px(plot.width);
      labels += `<text class="tick-y" x="${px(plot.left - 8)}" y="${px(y + 4)}">${tick.label}</text>`;
    }
    for (const label of plot.drawing.axes.querySelectorAll(".tick-x, .tick-y")) label.remove();
    plot.drawing.axes.querySelector(".grid").setAttribute("d", grid);
    plot.drawing.axes.querySelector(".grid").insertAdjacentHTML("afterend", labels);
  }
  drawScaleBar() {
    const { plot } = this;
    const perMetre = plot.width / (plot.view.x[1] - plot.view.x[0]);
    const longest = plot.width / 4 / perMetre;
    const power = 10 ** Math.floor(Math.log10(longest));
    const length = [5, 2, 1].map((factor) => factor * power).find((value) => value <= longest * 1.0000001);
    const bar = plot.drawing.ornaments.querySelector(".scale-bar");
    const start = bar.getAttribute("d").split("h")[0];
    bar.setAttribute("d", start + "h" + px(length * perMetre) + "v-6");
    const text = plot.drawing.ornaments.querySelector(".scale-text");
    text.setAttribute("x", px(plot.left + 16 + (length * perMetre) / 2));
    text.textContent = length >= 1000 ? Number((length / 1000).toPrecision(4)) + " km"
      : Number(length.toPrecision(4)) + " m";
  }
}
