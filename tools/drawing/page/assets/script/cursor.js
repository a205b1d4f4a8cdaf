// The cursor: one time, linked through all figures of the page, and the tip that tells what is there.

class Cursor {
  constructor(plot) {
    this.plot = plot;
    this.tip = document.createElement("div");
    this.tip.className = "tip";
    plot.element.append(this.tip);
  }

  /// The time that a place stands for: the x axis of figures over time, else that of the nearest point.
  timeAt(place) {
    if (this.plot.figure.link === "time") return this.plot.fromX(place.x);
    const found = this.nearestPoint(place, true);
    return found === null ? null : found.series.time[found.i];
  }
  nearestPoint(place, timed) {
    let best = null;
    let least = 40 * 40;
    for (const series of this.plot.visible()) {
      if (series.x === null || series.y === null || series.look === "road" || (timed && series.time === null)) continue;
      if (series.mark !== "line" && series.mark !== "points") continue;
      for (let i = 0; i < series.x.length; i += 1) {
        const distance = (this.plot.toX(series.x[i]) - place.x) ** 2 + (this.plot.toY(series.y[i]) - place.y) ** 2;
        // What says something of itself is preferred to the line that it lies on.
        const weighed = series.note && series.note[i] >= 0 ? distance - 30 : distance;
        if (weighed < least) {
          least = weighed;
          best = { series, i };
        }
      }
    }
    return best;
  }
  /// What there is to read at a time.
  readingsAt(time) {
    const readings = [];
    for (const series of this.plot.visible()) {
      if (series.time === null || series.time === undefined || series.y === null) continue;
      const i = nearest(series.time, time, series.reach);
      if (i < 0 || !Number.isFinite(series.y[i]) || !Number.isFinite(series.x[i])) continue;
      readings.push({ series, i });
    }
    return readings;
  }
  draw() {
    const parts = [];
    if (Cursor.time !== null) {
      if (this.plot.figure.link === "time") {
        const x = this.plot.toX(Cursor.time);
        if (x >= this.plot.left && x <= this.plot.left + this.plot.width)
          parts.push(`<path d="M${px(x)} ${px(this.plot.top)}v${px(this.plot.height)}"/>`);
      }
      for (const { series, i } of this.readingsAt(Cursor.time)) {
        const [x, y] = [this.plot.toX(series.x[i]), this.plot.toY(series.y[i])];
        if (!this.plot.holds(x, y)) continue;
        parts.push(`<circle class="look-${series.look}" cx="${px(x)}" cy="${px(y)}" r="5"/>`);
      }
    }
    this.plot.drawing.cursor.innerHTML = parts.join("");
  }
  showTip(place) {
    const lines = [];
    const { x, y } = this.plot.figure;
    const isTimed = this.plot.figure.link === "time";
    const found = isTimed ? null : this.nearestPoint(place, false);
    const readings = Cursor.time === null ? [] : this.readingsAt(Cursor.time);
    if (Cursor.time !== null && readings.length > 0) lines.push("<div>" + Cursor.time.toFixed(2) + " s</div>");
    const remarks = new Set();
    for (const { series, i } of readings) {
      if (isTimed) lines.push(`<div>${escaped(series.name || y.title)}: ${readable(series.y[i], y.unit)}</div>`);
      if (series.note && series.note[i] >= 0) remarks.add(series.notes[series.note[i]]);
    }
    if (found !== null && found.series.time === null) {
      const { series, i } = found;
      lines.push(`<div>${escaped(series.name)}</div><div>${escaped(x.title)}: ${readable(series.x[i], x.unit)}</div>` +
        `<div>${escaped(y.title)}: ${readable(series.y[i], y.unit)}</div>`);
    }
    if (found !== null && found.series.note && found.series.note[found.i] >= 0)
      remarks.add(found.series.notes[found.series.note[found.i]]);
    const place84 = this.plot.map ? this.plot.map.at(Cursor.time) : null;
    if (place84 !== null) lines.push(...place84.lines);
    for (const remark of remarks) lines.push(`<div class="remark">${escaped(remark)}</div>`);
    this.tip.innerHTML = lines.join("");
    const toCss = 1 / place.scale;
    const isRight = place.x > this.plot.left + this.plot.width / 2;
    this.tip.style.left = isRight ? "" : px(place.x * toCss + 14) + "px";
    this.tip.style.right = isRight ? px(this.plot.element.clientWidth - place.x * toCss + 14) + "px" : "";
    const svgTop = this.plot.svg.getBoundingClientRect().top - this.plot.element.getBoundingClientRect().top;
    this.tip.style.top = px(svgTop + place.y * toCss + 10) + "px";
    this.keepTipInSight();
  }
  /// Moves the tip until the window shows the whole of it.
  keepTipInSight() {
    const box = this.tip.getBoundingClientRect();
    const down = Math.min(0, window.innerHeight - 4 - box.bottom);
    if (down < 0) this.tip.style.top = px(parseFloat(this.tip.style.top) + Math.max(down, 4 - box.top)) + "px";
    const across = Math.max(4 - box.left, Math.min(0, document.documentElement.clientWidth - 4 - box.right));
    if (across === 0) return;
    this.tip.style.left = px(box.left + across - this.plot.element.getBoundingClientRect().left) + "px";
    this.tip.style.right = "";
  }
  point(place) {
    Cursor.time = this.timeAt(place);
    for (const plot of plots) plot.cursor.draw();
    if (this.plot.map) this.plot.map.follow(Cursor.time);
    this.showTip(place);
  }
  leave() {
    this.tip.innerHTML = "";
    Cursor.time = null;
    for (const plot of plots) plot.cursor.draw();
  }
  /// The cursor by so many samples of the longest series; the view follows.
  step(samples) {
    const timed = [...this.plot.visible()].filter((series) => series.time !== null);
    if (timed.length === 0) return;
    const { time } = timed.reduce((a, b) => (b.time.length > a.time.length ? b : a));
    const isFirst = Cursor.time === null && Number.isFinite(samples);
    const at = isFirst ? 0 : lowerBound(time, Cursor.time ?? time[0]) + samples;
    Cursor.time = time[Math.min(Math.max(at, 0), time.length - 1)];
    this.follow();
    for (const plot of plots) plot.cursor.draw();
    if (this.plot.map) this.plot.map.follow(Cursor.time);
    const { scale } = this.plot.place({ clientX: 0, clientY: 0 });
    const place = this.place() || { x: this.plot.figure.link === "time" ? this.plot.toX(Cursor.time) : this.plot.left,
      y: this.plot.top };
    this.showTip({ ...place, scale });
  }
  /// Where the cursor is on a map; null: not on this figure.
  place() {
    if (this.plot.figure.motion !== "map" || Cursor.time === null) return null;
    const reading = this.readingsAt(Cursor.time).find(({ series }) => series.look === "fused");
    return reading === undefined ? null
      : { x: this.plot.toX(reading.series.x[reading.i]), y: this.plot.toY(reading.series.y[reading.i]) };
  }
  /// Moves the view so that a cursor that left it is in its middle.
  follow() {
    const { plot } = this;
    if (plot.figure.motion === "still") return;
    const at = this.place() || { x: plot.figure.link === "time" ? plot.toX(Cursor.time) : plot.left, y: plot.top };
    if (plot.holds(at.x, at.y)) return;
    plot.pan(plot.left + plot.width / 2 - at.x, plot.figure.motion === "map" ? plot.top + plot.height / 2 - at.y : 0,
      plot.view);
  }
}
Cursor.time = null;
