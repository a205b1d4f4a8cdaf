// What the reader does with a figure: pointer, fingers, keys, buttons.

class Controls {
  constructor(plot) {
    this.plot = plot;
    this.fingers = new Map();
    const moves = plot.figure.motion !== "still";
    if (moves) plot.element.classList.add("moves", plot.figure.motion);
    for (const { svg } of Object.values(plot.drawings)) this.listen(svg, moves);
    this.addTools(moves);
    if (plot.map) plot.map.addTools();
  }

  listen(svg, moves) {
    const { cursor } = this.plot;
    if (moves) this.listenToMoves(svg);
    svg.setAttribute("tabindex", "0");
    svg.setAttribute("role", "group");  // an image cannot have a legend of buttons
    svg.addEventListener("pointermove", (event) => { if (!this.plot.drag) cursor.point(this.plot.place(event)); });
    svg.addEventListener("pointerleave", () => cursor.leave());
    svg.addEventListener("keydown", (event) => this.onKey(event));
    for (const entry of svg.querySelectorAll(".entry")) this.listenToEntry(entry);
  }
  listenToMoves(svg) {
    svg.addEventListener("wheel", (event) => {
      // Pages must scroll: the wheel zooms a figure that was clicked, or with a key held.
      const wanted = document.activeElement === svg || event.ctrlKey || event.shiftKey || event.metaKey;
      if (!wanted) return;
      event.preventDefault();
      this.plot.zoom(1.0015 ** (event.deltaY || event.deltaX), this.plot.place(event));
    }, { passive: false });
    svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || event.target.closest(".entry")) return;
      this.fingers.set(event.pointerId, event);
      this.plot.drag = { ...this.plot.place(event), view: this.plot.view };
      svg.setPointerCapture(event.pointerId);
      svg.focus({ preventScroll: true });
      this.plot.element.classList.add("dragged");
    });
    svg.addEventListener("pointermove", (event) => {
      if (!this.plot.drag) return;
      if (this.fingers.size === 2) {
        this.pinch(event);
        return;
      }
      const place = this.plot.place(event);
      this.plot.pan(place.x - this.plot.drag.x, place.y - this.plot.drag.y, this.plot.drag.view);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      svg.addEventListener(end, (event) => {
        this.fingers.delete(event.pointerId);
        this.plot.drag = null;
        this.plot.element.classList.remove("dragged");
        this.plot.drawSoon();
      });
    }
    svg.addEventListener("dblclick", () => this.plot.reset());
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
    if (before > 0 && spread() > 0) this.plot.zoom(before / spread(), this.plot.place(middle));
  }
  onKey(event) {
    const many = event.shiftKey ? 10 : 1;
    const { plot } = this;
    const { cursor } = plot;
    const actions = { ArrowLeft: () => cursor.step(-many), ArrowRight: () => cursor.step(many),
      Home: () => cursor.step(-Infinity), End: () => cursor.step(Infinity), Escape: () => cursor.leave() };
    if (plot.figure.motion !== "still") {
      Object.assign(actions, { "+": () => plot.zoom(0.7, cursor.place()), "-": () => plot.zoom(1 / 0.7, cursor.place()),
        0: () => plot.reset(), a: () => plot.panBy(-0.2, 0), d: () => plot.panBy(0.2, 0), w: () => plot.panBy(0, -0.2),
        s: () => plot.panBy(0, 0.2) });
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
    entry.setAttribute("aria-label", "show " + this.plot.series[index].name);
    const toggle = () => this.plot.toggle(index);
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
      button("+", "Zoom in (+, or the wheel over a figure that was clicked)", () => this.plot.zoom(0.6));
      button("\u2212", "Zoom out (-)", () => this.plot.zoom(1 / 0.6));
      button("whole", "Show the whole figure (0, or a double click)", () => this.plot.reset());
    }
    button("SVG", "Save this view as SVG", () => saveSvg(this.plot));
    button("CSV", "Save the numbers as CSV", () => saveCsv(this.plot));
    this.plot.element.querySelector("figcaption").prepend(tools);
  }
}
