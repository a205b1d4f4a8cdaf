// Moves the figures of a Waymark report: pan, zoom, a cursor that is linked through all figures by time, series
// switched off and on by the legend, files of what is seen. Without it the page is complete, but still.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const plots = [];

  // Numbers. Long columns are rounded: see tools/drawing/page/rounded_column.hpp.

  const columns = new Map();
  function summed({ step, differences }) {
    // A step of 0.001 is no binary number, 1000 is: dividing by it gives the decimal that was meant.
    const perUnit = step < 1 ? Math.round(1 / step) : 1;
    let sum = 0;
    return Float64Array.from(differences, (difference) => {
      if (difference === null) return NaN;
      sum += difference;
      return perUnit > 1 ? sum / perUnit : sum * step;
    });
  }
  function column(index) {
    if (index === undefined) return null;
    if (!columns.has(index)) {
      const stored = data.columns[index];
      const values = Array.isArray(stored)
        ? Float64Array.from(stored, (value) => (value === null ? NaN : value)) : summed(stored);
      columns.set(index, values);
    }
    return columns.get(index);
  }

  /// Index of the first value that is not below `wanted`. values: ascending
  function lowerBound(values, wanted) {
    let low = 0;
    let high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] < wanted) low = middle + 1; else high = middle;
    }
    return low;
  }
  /// Index of the value nearest to `wanted`, -1 where none is within `tolerance`.
  function nearest(values, wanted, tolerance) {
    let i = lowerBound(values, wanted);
    if (i > 0 && (i === values.length || wanted - values[i - 1] < values[i] - wanted)) i -= 1;
    return i < values.length && Math.abs(values[i] - wanted) <= tolerance ? i : -1;
  }
  function ascends(values) {
    for (let i = 1; i < values.length; i += 1) if (!(values[i] >= values[i - 1])) return false;
    return true;
  }
  /// Half as far again as neighbours usually are apart.
  function reach(times) {
    const steps = [];
    for (let i = 1; i < times.length; i += Math.ceil(times.length / 1000)) steps.push(times[i] - times[i - 1]);
    steps.sort((a, b) => a - b);
    return steps.length === 0 ? 1 : Math.max(1.5 * steps[steps.length >> 1], 0.5);
  }

  // Texts.

  function escaped(text) {
    const references = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
    return String(text).replace(/[&<>"']/g, (c) => references[c]);
  }
  const px = (value) => String(Math.round(value * 10) / 10);
  function readable(value, unit) {
    const text = Number.isFinite(value) ? String(Number(value.toPrecision(4))) : "-";
    return unit ? text + " " + unit : text;
  }

  // Axes. The same rules as view.cpp, for what is in view.

  function ticks(low, high, logarithmic, count) {
    const result = [];
    if (logarithmic) {
      const first = Math.floor(Math.log10(low));
      const last = Math.ceil(Math.log10(high));
      const every = Math.max(1, Math.floor((last - first) / 8));
      for (let power = first; power <= last; power += every) {
        for (const factor of high < 100 * low ? [1, 2, 5] : [1]) {
          const value = factor * 10 ** power;
          if (value >= low && value <= high) result.push({ value, label: String(Number(value.toPrecision(4))) });
        }
      }
      if (result.length > 2) return result;  // else the range is so narrow that even steps serve it
    }
    let even = [];
    const fewest = Math.max(count, 1);
    for (let wanted = fewest; even.length < 3 && wanted <= fewest + 6; wanted += 1) even = evenTicks(low, high, wanted);
    return even;
  }
  function evenTicks(low, high, count) {
    const result = [];
    const least = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((value) => value >= least) || 10 * power;
    const digits = Math.min(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), 12);
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9 && result.length < 100; k += 1) {
      const value = Math.abs(k * step) < step * 1e-6 ? 0 : k * step;
      const size = Math.max(Math.abs(value), step);
      const significant = Math.min(Math.max(Math.ceil(Math.log10(size / step) - 1e-9) + 1, 1), 15);
      const label = size >= 1e6 || step < 1e-5 ? String(Number(value.toPrecision(significant))) : value.toFixed(digits);
      result.push({ value, label });
    }
    return result;
  }

  /// What a map has besides its series: where on Earth the cursor is, the trajectory in colours of a
  /// quantity, and ellipses of the stated covariances where they are large enough to be seen.
  class MapLayer {
    constructor(plot, places) {
      this.plot = plot;
      this.start = places.start;
      for (const key of ["time", "x", "y", "latitude", "longitude", "xx", "xy", "yy"]) this[key] = column(places[key]);
      this.colours = plot.add("g", { class: "colours" });
      this.ellipses = plot.add("path", { class: "ellipses" });
      for (const layer of [this.ellipses, this.colours]) plot.marks.append(layer);
      this.by = "";
    }
    /// Quantities of other figures that are known over time: error, sigma, speed, NIS.
    static quantities() {
      const wanted = { "error-position": "error", sigma: "sigma", speed: "speed", nis: "NIS", hdop: "HDOP",
        "fix-residuals": "fix - fused" };
      const found = [];
      for (const [id, name] of Object.entries(wanted)) {
        const figure = data.figures[id];
        const series = figure && (figure.series.find((s) => s.look === "fused" && s.mark === "line")
          || figure.series.find((s) => s.mark === "line" && s.time !== undefined));
        if (series && series.time !== undefined) found.push({ id, name, unit: figure.y.unit, series });
      }
      return found;
    }
    addTools() {
      const tools = this.plot.element.querySelector(".tools");
      const select = document.createElement("select");
      select.className = "colour-by";
      select.setAttribute("aria-label", "Colour of the trajectory");
      select.add(new Option("one colour", ""));
      for (const { id, name } of MapLayer.quantities()) select.add(new Option("colour: " + name, id));
      select.addEventListener("change", () => { this.by = select.value; this.draw(); });
      this.link = document.createElement("a");
      this.link.className = "online";
      this.link.target = "_blank";
      this.link.rel = "noreferrer";
      this.link.textContent = "on-line map";
      this.link.title = "Opens openstreetmap.org at the cursor: the place is sent there";
      this.scale = document.createElement("span");
      this.scale.className = "colour-scale";
      tools.prepend(this.scale, select, this.link, " ");
      if (this.time.length > 0) this.follow(this.time[0]);
    }
    /// The place at a time: that of the nearest epoch, moved by what the trajectory moved since.
    at(time) {
      if (time === null || this.time.length === 0) return null;
      const i = nearest(this.time, time, 5);
      if (i < 0) return null;
      let [latitude, longitude] = [this.latitude[i], this.longitude[i]];
      const fused = this.plot.series.findIndex((series) => series.look === "fused" && series.mark === "line");
      const track = fused < 0 ? null : this.plot.loaded(fused);
      const k = track === null ? -1 : nearest(track.time, time, track.reach);
      if (k >= 0) {
        latitude += (track.y[k] - this.y[i]) / 111320;
        longitude += (track.x[k] - this.x[i]) / (111320 * Math.cos((latitude * Math.PI) / 180));
      }
      const lines = [`<div class="place">${latitude.toFixed(7)}, ${longitude.toFixed(7)}</div>`];
      if (this.start !== null) {
        const date = new Date((this.start + time) * 1000);
        lines.push(`<div>${date.toISOString().replace("T", " ").slice(0, 21)} UTC</div>`,
          `<div>${escaped(date.toLocaleTimeString([], { timeZoneName: "short" }))}, this computer's clock</div>`);
      }
      return { latitude, longitude, lines };
    }
    follow(time) {
      const place = this.at(time);
      if (place === null) return;
      const where = place.latitude.toFixed(6) + "/" + place.longitude.toFixed(6);
      this.link.href = "https://www.openstreetmap.org/?mlat=" + place.latitude.toFixed(6) + "&mlon=" +
        place.longitude.toFixed(6) + "#map=18/" + where;
    }
    draw() {
      this.drawColours();
      this.drawEllipses();
    }
    /// One path per colour, so that a long track costs no more than it did.
    drawColours() {
      const plot = this.plot;
      const quantity = MapLayer.quantities().find(({ id }) => id === this.by);
      this.colours.innerHTML = "";
      if (this.scale) this.scale.textContent = "";
      if (quantity === undefined) return;
      const times = column(quantity.series.time);
      const values = column(quantity.series.y);
      const sorted = Float64Array.from(values).filter(Number.isFinite).sort();
      if (sorted.length === 0) return;
      const low = sorted[0];
      const high = Math.max(sorted[Math.floor(0.98 * (sorted.length - 1))], low + 1e-9);
      const fused = plot.series.findIndex((series) => series.look === "fused" && series.mark === "line");
      if (fused < 0) return;
      const track = plot.loaded(fused);
      const hues = MapLayer.hues;
      const parts = hues.map(() => []);
      let [lastX, lastY, lastHue] = [NaN, NaN, -1];
      for (let k = 0, i = 0; k < track.x.length; k += 1) {
        while (i + 1 < times.length && times[i + 1] <= track.time[k]) i += 1;
        const x = plot.toX(track.x[k]);
        const y = plot.toY(track.y[k]);
        const near = Math.abs(x - lastX) + Math.abs(y - lastY) < 0.7;
        const hue = Number.isFinite(values[i])
          ? Math.min(hues.length - 1, Math.max(0, Math.floor((hues.length * (values[i] - low)) / (high - low)))) : -1;
        if (near && hue === lastHue) continue;
        const seen = x > plot.left && x < plot.left + plot.width && y > plot.top && y < plot.top + plot.height;
        if (hue >= 0 && seen && Number.isFinite(lastX)) parts[hue].push("M" + px(lastX) + " " + px(lastY) + "L" + px(x) + " " + px(y));
        [lastX, lastY, lastHue] = [x, y, hue];
      }
      this.colours.innerHTML = parts.map((part, h) => `<path class="colour" stroke="${hues[h]}" d="${part.join("")}"/>`).join("");
      this.scale.innerHTML = escaped(readable(low, "")) + hues.map((hue) => `<i style="background:${hue}"></i>`).join("") +
        escaped(readable(high, quantity.unit)) + " ";
    }
    /// Ellipses of 95 %: with two degrees of freedom the root of 5.99 sigmas.
    drawEllipses() {
      const plot = this.plot;
      const perMetre = plot.width / (plot.view.x[1] - plot.view.x[0]);
      const parts = [];
      for (let i = 0; this.xx !== null && i < this.xx.length; i += 1) {
        const x = plot.toX(this.x[i]);
        const y = plot.toY(this.y[i]);
        if (x < plot.left || x > plot.left + plot.width || y < plot.top || y > plot.top + plot.height) continue;
        const middle = 0.5 * (this.xx[i] + this.yy[i]);
        const off = Math.hypot(0.5 * (this.xx[i] - this.yy[i]), this.xy[i]);
        const major = 2.4477 * Math.sqrt(middle + off) * perMetre;
        const minor = 2.4477 * Math.sqrt(Math.max(middle - off, 0)) * perMetre;
        const degrees = (-0.5 * Math.atan2(2 * this.xy[i], this.xx[i] - this.yy[i]) * 180) / Math.PI;
        const arc = `a${px(major)} ${px(minor)} ${px(degrees)} 1 0 `;
        const [dx, dy] = [major * Math.cos((degrees * Math.PI) / 180), major * Math.sin((degrees * Math.PI) / 180)];
        if (major > 6) parts.push(`M${px(x - dx)} ${px(y - dy)}${arc}${px(2 * dx)} ${px(2 * dy)}${arc}${px(-2 * dx)} ${px(-2 * dy)}`);
      }
      // Many ellipses on each other are no picture: they appear when zoomed in.
      this.ellipses.setAttribute("d", parts.length <= 120 ? parts.join("") : "");
    }
  }
  MapLayer.hues = ["#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#a0da39", "#fde725"];

  class Plot {
    constructor(element, figure) {
      this.element = element;
      this.figure = figure;
      this.svg = element.querySelector("svg");
      this.marks = this.svg.querySelector(".marks");
      this.axes = this.svg.querySelector(".axes");
      this.ornaments = this.svg.querySelector(".ornaments");
      [this.left, this.top, this.width, this.height] = figure.box;
      this.home = { x: [figure.x.low, figure.x.high], y: [figure.y.low, figure.y.high] };
      this.view = this.home;
      this.hidden = new Set();
      this.fingers = new Map();
      this.series = figure.series.map((series, index) => ({ ...series, index, isLoaded: false }));
      this.cursor = this.add("g", { class: "cursor" });
      this.tip = document.createElement("div");
      this.tip.className = "tip";
      element.append(this.tip);
      this.map = figure.places ? new MapLayer(this, figure.places) : null;
      this.listen();
      if (this.map) this.map.addTools();
    }

    add(name, attributes) {
      const element = document.createElementNS("http://www.w3.org/2000/svg", name);
      for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
      this.svg.append(element);
      return element;
    }

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

    // Drawing.

    /// Part of a series that is in view along x, and one more at each end.
    inView(series) {
      if (!series.ascends) return [0, series.x.length];
      return [Math.max(lowerBound(series.x, this.view.x[0]) - 1, 0),
        Math.min(lowerBound(series.x, this.view.x[1]) + 1, series.x.length)];
    }

    linePath(series, ys, first = "M") {
      const [begin, end] = this.inView(series);
      return series.ascends ? this.columnsPath(series.x, ys, begin, end, first) : this.trackPath(series.x, ys);
    }
    /// First, lowest, highest and last point of each column of pixels.
    columnsPath(xs, ys, begin, end, first) {
      let path = "";
      let pen = first;
      let last = NaN;
      let kept = [];
      const flush = () => {
        let before = -1;
        for (const point of kept.sort((a, b) => a.i - b.i)) {
          if (point.i !== before) { path += pen + px(point.x) + " " + px(point.y); pen = "L"; }
          before = point.i;
        }
        kept = [];
      };
      for (let i = begin; i < end; i += 1) {
        const point = { i, x: this.toX(xs[i]), y: this.toY(ys[i]) };
        if (!Number.isFinite(point.x) || !Number.isFinite(point.y)) {
          flush();
          if (first === "M") pen = "M";
          continue;
        }
        if (kept.length > 0 && Math.floor(point.x) !== last) flush();
        last = Math.floor(point.x);
        if (kept.length === 0) kept = [point, point, point, point];
        if (point.y < kept[1].y) kept[1] = point;
        if (point.y > kept[2].y) kept[2] = point;
        kept[3] = point;
      }
      flush();
      return path;
    }
    /// Points less than 0.4 px from the last one are left out, and what is far outside. While the figure is dragged it is
    /// drawn more coarsely, so that it follows the hand.
    trackPath(xs, ys) {
      const scaleX = this.width / (this.view.x[1] - this.view.x[0]);
      const scaleY = this.height / (this.view.y[1] - this.view.y[0]);
      const right = this.left + this.width;
      const bottom = this.top + this.height;
      const near = this.drag ? 1.5 : 0.4;
      const parts = [];
      let pen = false;
      let lastX = 0;
      let lastY = 0;
      let beforeX = NaN;
      let beforeY = NaN;
      for (let i = 0; i < xs.length; i += 1) {
        const x = this.left + (xs[i] - this.view.x[0]) * scaleX;
        const y = bottom - (ys[i] - this.view.y[0]) * scaleY;
        // A piece is left out where both its ends lie on one outer side.
        const misses = !(Math.max(x, beforeX) >= this.left && Math.min(x, beforeX) <= right &&
          Math.max(y, beforeY) >= this.top && Math.min(y, beforeY) <= bottom);
        if (misses) {
          pen = false;
        } else if (!pen) {
          parts.push("M" + px(beforeX) + " " + px(beforeY) + "L" + px(x) + " " + px(y));
          [lastX, lastY] = [x, y];
          pen = true;
        } else if (Math.abs(x - lastX) + Math.abs(y - lastY) >= near) {
          parts.push("L" + px(x) + " " + px(y));
          [lastX, lastY] = [x, y];
        }
        [beforeX, beforeY] = [x, y];
      }
      return parts.join("");
    }
    markersPath(series) {
      const [begin, end] = this.inView(series);
      const side = this.drag ? 5 : 1.5;
      const taken = new Set();
      const parts = [];
      for (let i = begin; i < end; i += 1) {
        const x = this.toX(series.x[i]);
        const y = this.toY(series.y[i]);
        if (!(x >= this.left - 5 && x <= this.left + this.width + 5 && y >= this.top - 5 &&
              y <= this.top + this.height + 5)) continue;
        const square = Math.floor(x / side) * 8192 + Math.floor(y / side);
        if (taken.has(square)) continue;
        taken.add(square);
        parts.push("M" + px(x) + " " + px(y) + series.marker);
      }
      return parts.join("");
    }
    errorBarsPath(series) {
      let path = "";
      for (let i = 0; i < series.low.length; i += 1) {
        const [x, low, high] = [this.toX(series.x[i]), this.toY(series.low[i]), this.toY(series.high[i])];
        if (Number.isFinite(low) && Number.isFinite(high)) path += "M" + px(x) + " " + px(low) + "V" + px(high);
      }
      return path;
    }
    spansPath(series) {
      let path = "";
      for (let i = 0; i < series.low.length; i += 1) {
        const left = this.toX(series.low[i]);
        const right = Math.max(this.toX(series.high[i]), left + 1);
        if (right < this.left || left > this.left + this.width) continue;
        path += "M" + px(left) + " " + px(this.top) + "H" + px(right) + "v" + px(this.height) + "H" + px(left) + "z";
      }
      return path;
    }
    bandPath(series) {
      const back = { ...series, x: series.x };
      const upper = this.linePath(series, series.high);
      const lower = this.linePath(back, series.low, "L").split("L").filter((pair) => pair !== "").reverse();
      return upper === "" || lower.length === 0 ? "" : upper + "L" + lower.join("L") + "Z";
    }
    pathOf(series, element) {
      if (element.classList.contains("spread")) return this.errorBarsPath(series);
      switch (series.mark) {
        case "line": return this.linePath(series, series.y);
        case "points": return this.markersPath(series);
        case "spans": return this.spansPath(series);
        case "band": return this.bandPath(series);
        default: return null;
      }
    }

    drawAxes() {
      const [bottom, box] = [this.top + this.height, this.figure];
      let grid = "";
      let labels = "";
      for (const tick of ticks(...this.view.x, box.x.log, Math.floor(this.width / 90) + 1)) {
        const x = px(this.toX(tick.value));
        grid += "M" + x + " " + px(this.top) + "v" + px(this.height);
        labels += `<text class="tick-x" x="${x}" y="${px(bottom + 16)}">${tick.label}</text>`;
      }
      for (const tick of ticks(...this.view.y, box.y.log, Math.floor(this.height / 45) + 1)) {
        const y = this.toY(tick.value);
        grid += "M" + px(this.left) + " " + px(y) + "h" + px(this.width);
        labels += `<text class="tick-y" x="${px(this.left - 8)}" y="${px(y + 4)}">${tick.label}</text>`;
      }
      for (const label of this.axes.querySelectorAll(".tick-x, .tick-y")) label.remove();
      this.axes.querySelector(".grid").setAttribute("d", grid);
      this.axes.querySelector(".grid").insertAdjacentHTML("afterend", labels);
    }
    drawScaleBar() {
      const perMetre = this.width / (this.view.x[1] - this.view.x[0]);
      const longest = this.width / 4 / perMetre;
      const power = 10 ** Math.floor(Math.log10(longest));
      const length = [5, 2, 1].map((factor) => factor * power).find((value) => value <= longest * 1.0000001);
      const bar = this.ornaments.querySelector(".scale-bar");
      const start = bar.getAttribute("d").split("h")[0];
      bar.setAttribute("d", start + "h" + px(length * perMetre) + "v-6");
      const text = this.ornaments.querySelector(".scale-text");
      text.setAttribute("x", px(this.left + 16 + (length * perMetre) / 2));
      text.textContent = length >= 1000 ? Number((length / 1000).toPrecision(4)) + " km"
        : Number(length.toPrecision(4)) + " m";
    }
    draw() {
      for (const path of this.marks.querySelectorAll("[data-series]")) {
        const index = Number(path.dataset.series);
        path.classList.toggle("off", this.hidden.has(index));
        if (this.figure.motion === "still" || this.hidden.has(index)) continue;
        const drawn = this.pathOf(this.loaded(index), path);
        if (drawn !== null) path.setAttribute("d", drawn);
      }
      if (this.figure.motion !== "still") this.drawAxes();
      if (this.ornaments) this.drawScaleBar();
      if (this.map) this.map.draw();
      this.drawCursor();
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
    /// Where the cursor is on a map, so that keys zoom about it; null: about the middle.
    cursorPlace() {
      if (this.figure.motion !== "map" || Plot.time === null) return null;
      const reading = this.readingsAt(Plot.time).find(({ series }) => series.look === "fused");
      return reading === undefined ? null
        : { x: this.toX(reading.series.x[reading.i]), y: this.toY(reading.series.y[reading.i]) };
    }
    pan(dx, dy, from) {
      const shift = (range, by) => [range[0] + by, range[1] + by];
      const perPxX = (from.x[1] - from.x[0]) / this.width;
      const perPxY = (from.y[1] - from.y[0]) / this.height;
      this.moveTo({ x: shift(from.x, -dx * perPxX),
        y: this.figure.motion === "map" ? shift(from.y, dy * perPxY) : from.y });
    }
    reset() { this.moveTo(this.home); }

    // Pointing.

    /// The time that a place stands for: the x axis of figures over time, else that of the nearest point.
    timeAt(place) {
      if (this.figure.link === "time") return this.fromX(place.x);
      const found = this.nearestPoint(place, true);
      return found === null ? null : found.series.time[found.i];
    }
    nearestPoint(place, timed) {
      let best = null;
      let least = 40 * 40;
      for (const series of this.visible()) {
        if (series.x === null || series.y === null || (timed && series.time === null)) continue;
        if (series.mark !== "line" && series.mark !== "points") continue;
        for (let i = 0; i < series.x.length; i += 1) {
          const distance = (this.toX(series.x[i]) - place.x) ** 2 + (this.toY(series.y[i]) - place.y) ** 2;
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
      for (const series of this.visible()) {
        if (series.time === null || series.time === undefined || series.y === null) continue;
        const i = nearest(series.time, time, series.reach);
        if (i < 0 || !Number.isFinite(series.y[i]) || !Number.isFinite(series.x[i])) continue;
        readings.push({ series, i });
      }
      return readings;
    }
    drawCursor() {
      const parts = [];
      if (Plot.time !== null) {
        if (this.figure.link === "time") {
          const x = this.toX(Plot.time);
          if (x >= this.left && x <= this.left + this.width)
            parts.push(`<path d="M${px(x)} ${px(this.top)}v${px(this.height)}"/>`);
        }
        for (const { series, i } of this.readingsAt(Plot.time)) {
          const [x, y] = [this.toX(series.x[i]), this.toY(series.y[i])];
          if (x < this.left || x > this.left + this.width || y < this.top || y > this.top + this.height) continue;
          parts.push(`<circle class="look-${series.look}" cx="${px(x)}" cy="${px(y)}" r="5"/>`);
        }
      }
      this.cursor.innerHTML = parts.join("");
    }
    showTip(place) {
      const lines = [];
      const { x, y } = this.figure;
      const isTimed = this.figure.link === "time";
      const found = isTimed ? null : this.nearestPoint(place, false);
      const readings = Plot.time === null ? [] : this.readingsAt(Plot.time);
      if (Plot.time !== null && readings.length > 0) lines.push("<div>" + readable(Plot.time, "s") + "</div>");
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
      const place84 = this.map ? this.map.at(Plot.time) : null;
      if (place84 !== null) lines.push(...place84.lines);
      for (const remark of remarks) lines.push(`<div class="remark">${escaped(remark)}</div>`);
      this.tip.innerHTML = lines.join("");
      const toCss = 1 / place.scale;
      const isRight = place.x > this.left + this.width / 2;
      this.tip.style.left = isRight ? "" : px(place.x * toCss + 14) + "px";
      this.tip.style.right = isRight ? px(this.element.clientWidth - place.x * toCss + 14) + "px" : "";
      const svgTop = this.svg.getBoundingClientRect().top - this.element.getBoundingClientRect().top;
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
      this.tip.style.left = px(box.left + across - this.element.getBoundingClientRect().left) + "px";
      this.tip.style.right = "";
    }
    point(place) {
      Plot.time = this.timeAt(place);
      for (const plot of plots) plot.drawCursor();
      if (this.map) this.map.follow(Plot.time);
      this.showTip(place);
    }
    leave() {
      this.tip.innerHTML = "";
      Plot.time = null;
      for (const plot of plots) plot.drawCursor();
    }
    /// The cursor by so many samples of the longest series.
    step(samples) {
      const timed = [...this.visible()].filter((series) => series.time !== null);
      if (timed.length === 0) return;
      const { time } = timed.reduce((a, b) => (b.time.length > a.time.length ? b : a));
      const at = Plot.time === null ? 0 : lowerBound(time, Plot.time) + samples;
      Plot.time = time[Math.min(Math.max(at, 0), time.length - 1)];
      for (const plot of plots) plot.drawCursor();
      if (this.map) this.map.follow(Plot.time);
      const x = this.figure.link === "time" ? this.toX(Plot.time) : this.left;
      this.showTip({ x, y: this.top, scale: this.place({ clientX: 0, clientY: 0 }).scale });
    }

    // Events.

    listen() {
      const moves = this.figure.motion !== "still";
      if (moves) {
        this.element.classList.add("moves", this.figure.motion);
        this.listenToMoves();
      }
      this.svg.setAttribute("tabindex", "0");
      this.svg.setAttribute("role", "group");  // an image cannot have a legend of buttons
      this.svg.addEventListener("pointermove", (event) => { if (!this.drag) this.point(this.place(event)); });
      this.svg.addEventListener("pointerleave", () => this.leave());
      this.svg.addEventListener("keydown", (event) => this.onKey(event));
      for (const entry of this.svg.querySelectorAll(".entry")) this.listenToEntry(entry);
      this.addTools(moves);
    }
    listenToMoves() {
      this.svg.addEventListener("wheel", (event) => {
        // Pages must scroll: the wheel zooms a figure that was clicked, or with a key held.
        const wanted = document.activeElement === this.svg || event.ctrlKey || event.shiftKey || event.metaKey;
        if (!wanted) return;
        event.preventDefault();
        this.zoom(1.0015 ** (event.deltaY || event.deltaX), this.place(event));
      }, { passive: false });
      this.svg.addEventListener("pointerdown", (event) => {
        if (event.button !== 0 || event.target.closest(".entry")) return;
        this.fingers.set(event.pointerId, event);
        this.drag = { ...this.place(event), view: this.view };
        this.svg.setPointerCapture(event.pointerId);
        this.svg.focus({ preventScroll: true });
        this.element.classList.add("dragged");
      });
      this.svg.addEventListener("pointermove", (event) => {
        if (!this.drag) return;
        if (this.fingers.size === 2) {
          this.pinch(event);
          return;
        }
        const place = this.place(event);
        this.pan(place.x - this.drag.x, place.y - this.drag.y, this.drag.view);
      });
      for (const end of ["pointerup", "pointercancel"]) {
        this.svg.addEventListener(end, (event) => {
          this.fingers.delete(event.pointerId);
          this.drag = null;
          this.element.classList.remove("dragged");
          this.drawSoon();
        });
      }
      this.svg.addEventListener("dblclick", () => this.reset());
    }
    /// Zooms by how far two fingers went apart, about their middle.
    pinch(event) {
      const spread = () => {
        const [a, b] = [...this.fingers.values()];
        return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
      };
      const before = spread();
      this.fingers.set(event.pointerId, event);
      const [a, b] = [...this.fingers.values()];
      const middle = { clientX: 0.5 * (a.clientX + b.clientX), clientY: 0.5 * (a.clientY + b.clientY) };
      if (before > 0 && spread() > 0) this.zoom(before / spread(), this.place(middle));
    }
    onKey(event) {
      const many = event.shiftKey ? 10 : 1;
      const moves = this.figure.motion !== "still";
      const actions = { ArrowLeft: () => this.step(-many), ArrowRight: () => this.step(many), Escape: () => this.leave() };
      if (moves) {
        actions["+"] = () => this.zoom(0.7, this.cursorPlace());
        actions["-"] = () => this.zoom(1 / 0.7, this.cursorPlace());
        actions["0"] = () => this.reset();
      }
      if (actions[event.key] === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      actions[event.key]();
    }
    listenToEntry(entry) {
      const index = Number(entry.dataset.series);
      entry.setAttribute("role", "button");
      entry.setAttribute("tabindex", "0");
      entry.setAttribute("aria-pressed", "true");
      entry.setAttribute("aria-label", "show " + this.series[index].name);
      const toggle = () => {
        if (this.hidden.has(index)) this.hidden.delete(index); else this.hidden.add(index);
        entry.classList.toggle("off", this.hidden.has(index));
        entry.setAttribute("aria-pressed", String(!this.hidden.has(index)));
        this.drawSoon();
      };
      entry.addEventListener("click", toggle);
      entry.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        toggle();
      });
    }
    addTools(moves) {
      const tools = document.createElement("div");
      tools.className = "tools";
      const button = (text, title, action) => {
        const made = document.createElement("button");
        made.type = "button";
        made.textContent = text;
        made.title = title;
        made.setAttribute("aria-label", title);
        made.addEventListener("click", action);
        tools.append(made);
      };
      if (moves) {
        button("+", "Zoom in (+, or the wheel over a figure that was clicked)", () => this.zoom(0.6));
        button("\u2212", "Zoom out (-)", () => this.zoom(1 / 0.6));
        button("whole", "Show the whole figure (0, or a double click)", () => this.reset());
      }
      button("SVG", "Save this view as SVG", () => this.saveSvg());
      button("CSV", "Save the numbers as CSV", () => this.saveCsv());
      this.element.querySelector("figcaption").prepend(tools);
    }

    // Files.

    save(text, type, ending) {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text], { type }));
      link.download = this.element.id + ending;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }
    saveSvg() {
      const copy = this.svg.cloneNode(true);
      copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
      for (const odd of copy.querySelectorAll(".cursor, .off")) odd.remove();
      const style = document.createElementNS("http://www.w3.org/2000/svg", "style");
      style.textContent = document.querySelector("style").textContent;
      copy.prepend(style);
      this.save(new XMLSerializer().serializeToString(copy), "image/svg+xml", ".svg");
    }
    saveCsv() {
      const quoted = (text) => (/[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text);
      const keys = ["x", "y", "low", "high", "time"];
      const all = this.series.map((series, index) => this.loaded(index));
      const used = keys.filter((key) => all.some((series) => series[key]));
      const headings = { x: this.figure.x.heading, y: this.figure.y.heading, low: "low", high: "high", time: "time [s]" };
      const rows = [["series", ...used.map((key) => headings[key]), "note"].map(quoted).join(",")];
      for (const series of all) {
        const length = Math.max(...used.map((key) => (series[key] ? series[key].length : 0)));
        for (let i = 0; i < length; i += 1) {
          const cells = used.map((key) => (series[key] && Number.isFinite(series[key][i]) ? String(series[key][i]) : ""));
          const note = series.note && series.note[i] >= 0 ? series.notes[series.note[i]] : "";
          rows.push([quoted(series.name), ...cells, quoted(note)].join(","));
        }
      }
      this.save(rows.join("\n") + "\n", "text/csv", ".csv");
    }
  }
  Plot.time = null;

  for (const [id, figure] of Object.entries(data.figures)) plots.push(new Plot(document.getElementById(id), figure));
  addEventListener("scroll", () => {
    for (const plot of plots) if (plot.isDue && plot.isInSight()) requestAnimationFrame(() => plot.drawDue());
  }, { passive: true });
  addEventListener("beforeprint", () => {
    for (const plot of plots) plot.drawDue();
    for (const folded of document.querySelectorAll("details")) folded.open = true;
  });
  document.documentElement.dataset.ready = String(plots.length);
})();
