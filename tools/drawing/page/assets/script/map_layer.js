// What a map has besides its series.

const RISING_HUES = ["#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#a0da39", "#fde725"];
const KIND_HUES = ["#009e73", "#e69f00", "#d55e00", "#0072b2", "#cc79a7", "#5b4a9e", "#56b4e9", "#777777"];

/// Hues for values of a quantity. The highest 2 % share the last hue: a few outliers would take all the others.
function valueScale({ values, unit }) {
  const sorted = Float64Array.from(values).filter(Number.isFinite).sort();
  if (sorted.length === 0) return null;
  const low = sorted[0];
  const high = Math.max(sorted[Math.floor(0.98 * (sorted.length - 1))], low + 1e-9);
  const hues = RISING_HUES;
  const hueOf = (value) => Math.min(hues.length - 1, Math.max(0, Math.floor((hues.length * (value - low)) / (high - low))));
  const boxes = hues.map((hue) => `<i style="background:${hue}"></i>`).join("");
  return { hues, hueOf, html: escaped(readable(low, "")) + boxes + escaped(readable(high, unit)) + " " };
}
/// A hue for each kind, which has a name.
function kindScale({ kinds }) {
  const hues = kinds.map((kind, k) => KIND_HUES[k % KIND_HUES.length]);
  const html = kinds.map((kind, k) => `<i style="background:${hues[k]}"></i> ${escaped(kind)} `).join("");
  return { hues, hueOf: (value) => value, html };
}

/// What a map has besides its series: where on Earth the cursor is, the trajectory in colours of a
/// quantity, and ellipses of the stated covariances where they are large enough to be seen.
class MapLayer {
  constructor(plot, places) {
    this.plot = plot;
    this.start = places.start;
    this.qualities = places.qualities || [];
    for (const key of ["time", "x", "y", "latitude", "longitude", "xx", "xy", "yy", "quality"])
      this[key] = column(places[key]);
    for (const drawing of Object.values(plot.drawings)) {
      drawing.ellipses = svgElement("path", { class: "ellipses" });
      drawing.colours = svgElement("g", { class: "colours" });
      drawing.svg.querySelector(".marks").append(drawing.ellipses, drawing.colours);
    }
    this.by = "";
  }
  get colours() { return this.plot.drawing.colours; }
  get ellipses() { return this.plot.drawing.ellipses; }
  /// What the trajectory can be coloured by: the quality of the fixes, and quantities of other figures that are known
  /// over time.
  quantities() {
    const wanted = { "error-position": "error", sigma: "sigma", speed: "speed", nis: "NIS", hdop: "HDOP",
      "fix-residuals": "fix - fused" };
    const found = [];
    for (const [id, name] of Object.entries(wanted)) {
      const figure = data.figures[id];
      const series = figure && (figure.series.find((s) => s.look === "fused" && s.mark === "line")
        || figure.series.find((s) => s.mark === "line" && s.time !== undefined));
      if (series && series.time !== undefined)
        found.push({ id, name, unit: figure.y.unit, times: column(series.time), values: column(series.y) });
    }
    if (this.quality !== null)
      found.push({ id: "quality", name: "fix quality", times: this.time, values: this.quality, kinds: this.qualities });
    return found;
  }
  addTools() {
    const tools = this.plot.element.querySelector(".tools");
    const select = document.createElement("select");
    select.className = "colour-by";
    select.setAttribute("aria-label", "Colour of the trajectory");
    select.add(new Option("one colour", ""));
    for (const { id, name } of this.quantities()) select.add(new Option("colour: " + name, id));
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
    const quantity = this.quantities().find(({ id }) => id === this.by);
    this.colours.innerHTML = "";
    if (this.scale) this.scale.textContent = "";
    if (quantity === undefined) return;
    const scale = quantity.kinds ? kindScale(quantity) : valueScale(quantity);
    const fused = this.plot.series.findIndex((series) => series.look === "fused" && series.mark === "line");
    if (scale === null || fused < 0) return;
    const parts = this.partsByHue(this.plot.loaded(fused), quantity, scale);
    this.colours.innerHTML = parts
      .map((part, h) => `<path class="colour" stroke="${scale.hues[h]}" d="${part.join("")}"/>`).join("");
    this.scale.innerHTML = scale.html;
  }
  /// The pieces of the track that are in view, by the hue of the value that was last known.
  partsByHue(track, { times, values }, { hues, hueOf }) {
    const plot = this.plot;
    const parts = hues.map(() => []);
    let [lastX, lastY, lastHue] = [NaN, NaN, -1];
    for (let k = 0, i = 0; k < track.x.length; k += 1) {
      while (i + 1 < times.length && times[i + 1] <= track.time[k]) i += 1;
      const x = plot.toX(track.x[k]);
      const y = plot.toY(track.y[k]);
      const near = Math.abs(x - lastX) + Math.abs(y - lastY) < 0.7;
      const hue = Number.isFinite(values[i]) ? hueOf(values[i]) : -1;
      if (near && hue === lastHue) continue;
      if (hue >= 0 && plot.holds(x, y) && Number.isFinite(lastX))
        parts[hue].push("M" + px(lastX) + " " + px(lastY) + "L" + px(x) + " " + px(y));
      [lastX, lastY, lastHue] = [x, y, hue];
    }
    return parts;
  }
  /// Ellipses of 95 %: with two degrees of freedom the root of 5.99 sigmas.
  drawEllipses() {
    const plot = this.plot;
    const perMetre = plot.width / (plot.view.x[1] - plot.view.x[0]);
    const parts = [];
    for (let i = 0; this.xx !== null && i < this.xx.length; i += 1) {
      const x = plot.toX(this.x[i]);
      const y = plot.toY(this.y[i]);
      if (!plot.holds(x, y)) continue;
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
