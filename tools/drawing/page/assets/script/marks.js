// The paths of the marks that are in view. The same rules as thinning.cpp and marks_svg.cpp.

class Marks {
  constructor(plot) { this.plot = plot; }

  /// Part of a series that is in view along x, and one more at each end.
  inView(series) {
    if (!series.ascends) return [0, series.x.length];
    return [Math.max(lowerBound(series.x, this.plot.view.x[0]) - 1, 0),
      Math.min(lowerBound(series.x, this.plot.view.x[1]) + 1, series.x.length)];
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
      const point = { i, x: this.plot.toX(xs[i]), y: this.plot.toY(ys[i]) };
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
    const scaleX = this.plot.width / (this.plot.view.x[1] - this.plot.view.x[0]);
    const scaleY = this.plot.height / (this.plot.view.y[1] - this.plot.view.y[0]);
    const right = this.plot.left + this.plot.width;
    const bottom = this.plot.top + this.plot.height;
    const near = this.plot.drag ? 1.5 : 0.4;
    const parts = [];
    let pen = false;
    let lastX = 0;
    let lastY = 0;
    let beforeX = NaN;
    let beforeY = NaN;
    for (let i = 0; i < xs.length; i += 1) {
      const x = this.plot.left + (xs[i] - this.plot.view.x[0]) * scaleX;
      const y = bottom - (ys[i] - this.plot.view.y[0]) * scaleY;
      // A piece is left out where both its ends lie on one outer side.
      const misses = !(Math.max(x, beforeX) >= this.plot.left && Math.min(x, beforeX) <= right &&
        Math.max(y, beforeY) >= this.plot.top && Math.min(y, beforeY) <= bottom);
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
    const side = this.plot.drag ? 5 : 2.5;
    const taken = new Set();
    const parts = [];
    for (let i = begin; i < end; i += 1) {
      const x = this.plot.toX(series.x[i]);
      const y = this.plot.toY(series.y[i]);
      if (!(x >= this.plot.left - 5 && x <= this.plot.left + this.plot.width + 5 && y >= this.plot.top - 5 &&
            y <= this.plot.top + this.plot.height + 5)) continue;
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
      const [x, low, high] = [this.plot.toX(series.x[i]), this.plot.toY(series.low[i]), this.plot.toY(series.high[i])];
      if (Number.isFinite(low) && Number.isFinite(high)) path += "M" + px(x) + " " + px(low) + "V" + px(high);
    }
    return path;
  }
  spansPath(series) {
    let path = "";
    for (let i = 0; i < series.low.length; i += 1) {
      const left = this.plot.toX(series.low[i]);
      const right = Math.max(this.plot.toX(series.high[i]), left + 1);
      if (right < this.plot.left || left > this.plot.left + this.plot.width) continue;
      path += "M" + px(left) + " " + px(this.plot.top) + "H" + px(right) + "v" + px(this.plot.height) + "H" + px(left) + "z";
    }
    return path;
  }
  bandPath(series) {
    const back = { ...series, x: series.x };
    const upper = this.linePath(series, series.high);
    const lower = this.linePath(back, series.low, "L").split("L").filter((pair) => pair !== "").reverse();
    return upper === "" || lower.length === 0 ? "" : upper + "L" + lower.join("L") + "Z";
  }
  /// The rings of which a part is in view, each as a whole: a part of a ring has no inside.
  areasPath(series) {
    const { plot } = this;
    const parts = [];
    let ring = [];
    let box = [Infinity, -Infinity, Infinity, -Infinity];
    const close = () => {
      const seen = box[1] >= plot.left && box[0] <= plot.left + plot.width && box[3] >= plot.top &&
        box[2] <= plot.top + plot.height;
      if (seen && ring.length > 2) parts.push("M" + ring.join("L") + "Z");
      ring = [];
      box = [Infinity, -Infinity, Infinity, -Infinity];
    };
    for (let i = 0; i < series.x.length; i += 1) {
      const [x, y] = [plot.toX(series.x[i]), plot.toY(series.y[i])];
      if (!Number.isFinite(x) || !Number.isFinite(y)) { close(); continue; }
      ring.push(px(x) + " " + px(y));
      box = [Math.min(box[0], x), Math.max(box[1], x), Math.min(box[2], y), Math.max(box[3], y)];
    }
    close();
    return parts.join("");
  }
  pathOf(series, element) {
    if (element.classList.contains("spread")) return this.errorBarsPath(series);
    switch (series.mark) {
      case "line": return this.linePath(series, series.y);
      case "points": return this.markersPath(series);
      case "spans": return this.spansPath(series);
      case "band": return this.bandPath(series);
      case "areas": return this.areasPath(series);
      default: return null;
    }
  }

}
