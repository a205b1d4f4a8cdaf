// A figure that moves: its view of the data, and how it is drawn.

const plots = [];

function svgElement(name, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

class Plot {
  constructor(element, figure) {
    this.element = element;
    this.figure = figure;
    this.series = figure.series.map((series, index) => ({ ...series, index, isLoaded: false }));
    this.hidden = new Set();
    this.drawings = {};
    for (const [screen, { box, x, y }] of Object.entries(figure.drawings)) {
      const svg = element.querySelector("svg." + screen);
      this.drawings[screen] = { svg, box, home: { x, y }, marks: svg.querySelector(".marks"),
        axes: svg.querySelector(".axes"), ornaments: svg.querySelector(".ornaments"),
        cursor: svg.appendChild(svgElement("g", { class: "cursor" })) };
    }
    this.marks = new Marks(this);
    this.axes = new Axes(this);
    this.map = figure.places ? new MapLayer(this, figure.places) : null;
    this.takeVisible();
    this.cursor = new Cursor(this);
    this.controls = new Controls(this);
  }

  // The drawing for this screen.

  /// Takes the drawing that the style sheet shows.
  takeVisible() {
    const shown = Object.values(this.drawings).find(({ svg }) => getComputedStyle(svg).display !== "none");
    if (shown !== undefined) this.take(shown);
  }
  take(drawing) {
    if (drawing === this.drawing) return;
    const wasHome = this.drawing === undefined || this.view === this.drawing.home;
    this.drawing = drawing;
    this.svg = drawing.svg;
    this.home = drawing.home;
    [this.left, this.top, this.width, this.height] = drawing.box;
    this.view = wasHome ? this.home : this.inThisShape(this.view);
    // A drawing at home is as it was made, but for series that are switched off and for colours.
    if (!wasHome || this.hidden.size > 0 || (this.map && this.map.by !== "")) this.drawSoon();
  }
  /// The same view in a box of another shape: of a map the middle and what is seen of x stay.
  inThisShape(view) {
    if (this.figure.motion !== "map") return view;
    const middle = 0.5 * (view.y[0] + view.y[1]);
    const half = (0.5 * (view.x[1] - view.x[0]) * this.height) / this.width;
    return { x: view.x, y: [middle - half, middle + half] };
  }

  // Series.

  /// The series with its columns, which are made when first needed.
  loaded(index) {
    const series = this.series[index];
    if (!series.isLoaded) {
      for (const key of ["x", "y", "low", "high", "time", "note"]) series[key] = column(series[key]);
      series.ascends = series.x !== null && ascends(series.x);
      series.reach = series.time === null ? 0 : reach(series.time);
      series.isLoaded = true;
    }
    return series;
  }
  *visible() {
    for (let i = 0; i < this.series.length; i += 1) if (!this.hidden.has(i)) yield this.loaded(i);
  }
  toggle(index) {
    if (this.hidden.has(index)) this.hidden.delete(index); else this.hidden.add(index);
    for (const { svg } of Object.values(this.drawings)) {
      for (const entry of svg.querySelectorAll(`.entry[data-series="${index}"]`)) {
        entry.classList.toggle("off", this.hidden.has(index));
        entry.setAttribute("aria-pressed", String(!this.hidden.has(index)));
      }
    }
    this.drawSoon();
  }

  // Data to px and back.

  static part(axis, range, value) {
    return axis.log ? Math.log(value / range[0]) / Math.log(range[1] / range[0])
      : (value - range[0]) / (range[1] - range[0]);
  }
  toX(value) { return this.left + this.width * Plot.part(this.figure.x, this.view.x, value); }
  toY(value) {
    const up = Plot.part(this.figure.y, this.view.y, value);
    return this.top + this.height * (this.figure.downwards ? up : 1 - up);
  }
  fromX(place) {
    const part = (place - this.left) / this.width;
    const [low, high] = this.view.x;
    return this.figure.x.log ? low * (high / low) ** part : low + part * (high - low);
  }
  fromY(place) {
    const part = 1 - (place - this.top) / this.height;
    return this.view.y[0] + part * (this.view.y[1] - this.view.y[0]);
  }
  /// Of a pointer event, in the units of the drawing.
  place(event) {
    const box = this.svg.getBoundingClientRect();
    const scale = this.svg.viewBox.baseVal.width / box.width;
    return { x: (event.clientX - box.left) * scale, y: (event.clientY - box.top) * scale, scale };
  }
  holds(x, y) {
    return x >= this.left && x <= this.left + this.width && y >= this.top && y <= this.top + this.height;
  }

  // Drawing.

  draw() {
    for (const path of this.drawing.marks.querySelectorAll("[data-series]")) {
      const index = Number(path.dataset.series);
      path.classList.toggle("off", this.hidden.has(index));
      if (this.figure.motion === "still" || this.hidden.has(index)) continue;
      const drawn = this.marks.pathOf(this.loaded(index), path);
      if (drawn !== null) path.setAttribute("d", drawn);
    }
    this.axes.draw();
    if (this.map) this.map.draw();
    this.cursor.draw();
  }
  /// Once before the next picture, however many events came; a figure out of sight when it is scrolled to.
  drawSoon() {
    this.element.dataset.view = [...this.view.x, ...this.view.y].map((v) => v.toPrecision(9)).join(" ");
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => { if (this.isInSight()) this.drawDue(); });
  }
  drawDue() {
    if (!this.isDue) return;
    this.isDue = false;
    this.draw();
  }
  isInSight() {
    const box = this.svg.getBoundingClientRect();
    return box.bottom > 0 && box.top < window.innerHeight;
  }

  // Moving.

  moveTo(view) {
    if (this.figure.motion === "x") {
      for (const plot of plots) {
        if (plot !== this && !(this.figure.link !== "" && plot.figure.link === this.figure.link)) continue;
        plot.view = { x: view.x, y: plot.fitted(view.x) };
        plot.drawSoon();
      }
      return;
    }
    this.view = view;
    this.drawSoon();
  }
  /// The y axis for what is seen of x.
  fitted(range) {
    const isHome = range[0] === this.home.x[0] && range[1] === this.home.x[1];
    if (isHome || this.figure.y.log || this.figure.y.rows) return this.home.y;
    let low = Infinity;
    let high = -Infinity;
    for (const series of this.visible()) {
      if (series.mark !== "line" && series.mark !== "points") continue;
      for (let i = 0; i < series.x.length; i += 1) {
        if (!(series.x[i] >= range[0] && series.x[i] <= range[1]) || !Number.isFinite(series.y[i])) continue;
        low = Math.min(low, series.y[i]);
        high = Math.max(high, series.y[i]);
      }
    }
    if (!(low < high)) return this.home.y;
    const pad = 0.06 * (high - low);
    return [this.figure.y.held ? this.home.y[0] : low - pad, high + pad];
  }
  zoom(factor, place) {
    const centre = place || { x: this.left + this.width / 2, y: this.top + this.height / 2 };
    const about = (range, middle) => range.map((end) => middle + (end - middle) * factor);
    const x = about(this.view.x, this.fromX(centre.x));
    const tooFar = x[1] - x[0] > 50 * (this.home.x[1] - this.home.x[0]);
    const tooNear = x[1] - x[0] < 1e-6 * (this.home.x[1] - this.home.x[0]);
    if (tooFar || tooNear) return;
    this.moveTo({ x, y: this.figure.motion === "map" ? about(this.view.y, this.fromY(centre.y)) : this.view.y });
  }
  pan(dx, dy, from) {
    const shift = (range, by) => [range[0] + by, range[1] + by];
    const perPxX = (from.x[1] - from.x[0]) / this.width;
    const perPxY = (from.y[1] - from.y[0]) / this.height;
    this.moveTo({ x: shift(from.x, -dx * perPxX),
      y: this.figure.motion === "map" ? shift(from.y, dy * perPxY) : from.y });
  }
  /// Moves by parts of what is in view.
  panBy(partX, partY) { this.pan(-partX * this.width, -partY * this.height, this.view); }
  reset() { this.moveTo(this.home); }
}
