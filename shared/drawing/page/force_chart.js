// What a run's executor felt over time, a row an axis, with the thresholds that its contacts are told by; and what
// the part touched, a row a name.

class ForceChart {
  // jump: called with a time in s.
  constructor(host, jump) {
    this.host = element("div", { class: "chart" });
    host.append(this.host);
    this.jump = jump;
    this.time = 0;
    new ResizeObserver(() => this.build()).observe(this.host);
  }

  // axes: 0 to 5, a row each.
  setReplay(replay, axes, title) {
    Object.assign(this, { replay, axes, title });
    this.build();
  }

  build() {
    if (!this.replay || !this.host.clientWidth) return;
    const width = Math.max(this.host.clientWidth, 280);
    const height = 84;
    this.left = 70;
    this.span = width - this.left - 12;
    const forces = this.axes.length * height;
    const names = this.replay.names();
    const bottom = forces + 22 * names.length;
    const svg = svgElement("svg", {
      role: "img",
      "aria-label": this.label(),
      viewBox: `0 0 ${width} ${bottom + 30}`,
      width,
      height: bottom + 30,
      class: "forces",
    });
    this.buildTime(svg, bottom);
    this.axes.forEach((axis, i) => this.buildRow(svg, axis, i * height, height));
    names.forEach((name, i) => this.buildTouches(svg, name, forces + 22 * i));
    this.cursor = svgElement("line", { y1: 0, y2: bottom, class: "cursor" });
    svg.append(this.cursor);
    svg.addEventListener("click", (event) => {
      const at = event.clientX - svg.getBoundingClientRect().left;
      this.jump((this.replay.end * (at - this.left)) / this.span);
    });
    this.host.replaceChildren(svg);
    this.show(this.time);
  }

  x(time) {
    return this.left + (this.span * time) / this.replay.end;
  }

  label() {
    const most = this.axes.map((axis) => {
      const value = Math.max(...this.replay.recording.wrench[axis].map(Math.abs));
      return `${AXES[axis]} at most ${value.toFixed(axis < 3 ? 1 : 2)} ${axis < 3 ? "N" : "Nm"}`;
    });
    return `${this.title}: what the sensor felt over ${this.replay.end.toFixed(1)} s, ${most.join(", ")}`;
  }

  // Seconds, and where one step ends and the next begins.
  buildTime(svg, bottom) {
    const wanted = (70 * this.replay.end) / this.span;
    const every = [0.5, 1, 2, 5, 10, 20, 50, 100].find((step) => step >= wanted) || 200;
    for (let time = 0; time <= this.replay.end + 1e-9; time += every) {
      svg.append(
        svgElement(
          "text",
          { x: this.x(time), y: bottom + 22, class: "tick", "text-anchor": "middle" },
          time + " s",
        ),
      );
    }
    for (const stop of this.replay.stops) {
      svg.append(
        svgElement("line", { x1: this.x(stop), x2: this.x(stop), y1: 4, y2: bottom, class: "grid" }),
      );
    }
  }

  // Threshold of each moment's step, as one line with its jumps.
  thresholds(axis, name, y) {
    const { times_s, steps } = this.replay.recording;
    let path = "";
    let last = null;
    steps.forEach((step, i) => {
      const value = this.replay.steps[step]?.[name + (axis < 3 ? "_N" : "_Nm")];
      if (value === undefined) return;
      const x = this.x(times_s[Math.max(i - 1, 0)]).toFixed(1);
      if (value !== last) path += (last === null ? "M" : `H${x}M`) + `${x},${y(value).toFixed(1)}`;
      last = value;
    });
    return path + `H${this.x(this.replay.end).toFixed(1)}`;
  }

  buildRow(svg, axis, top, height) {
    const { times_s, wrench } = this.replay.recording;
    const kind = axis < 3 ? "force" : "torque";
    const on = this.replay.steps.map((step) => (axis < 3 ? step.force_on_N : step.torque_on_Nm));
    const most = 1.08 * Math.max(...wrench[axis].map(Math.abs), 1.15 * Math.max(...on));
    const middle = top + height / 2;
    const y = (value) => middle - ((height / 2 - 5) * value) / most;
    svg.append(
      svgElement("line", { x1: this.left, x2: this.left + this.span, y1: middle, y2: middle, class: "base" }),
    );
    for (const sign of [1, -1]) {
      for (const name of ["on", "off"]) {
        const d = this.thresholds(axis, `${kind}_${name}`, (value) => y(sign * value));
        svg.append(svgElement("path", { d, class: "threshold " + name }));
      }
    }
    const points = times_s.map((time, i) => `${this.x(time).toFixed(1)},${y(wrench[axis][i]).toFixed(1)}`);
    const text = (sign) => sign + on[0].toFixed(axis < 3 ? 0 : 1) + (axis < 3 ? " N" : " Nm");
    const tick = (at, sign) =>
      svgElement("text", { x: this.left - 6, y: at + 4, class: "tick", "text-anchor": "end" }, text(sign));
    const apart = y(-on[0]) - y(on[0]) > 26;
    svg.append(
      svgElement("polyline", { points: points.join(" "), class: "curve" }),
      svgElement("text", { x: 0, y: middle + 5, class: "label" }, AXES[axis]),
      ...(apart ? [tick(y(on[0]), "+"), tick(y(-on[0]), "−")] : [tick(middle, "±")]),
    );
  }

  buildTouches(svg, name, top) {
    const y = top + 6;
    svg.append(svgElement("text", { x: 0, y: y + 10, class: "tick" }, name));
    for (const [from, to] of this.replay.spansOf(name)) {
      const width = Math.max(this.x(to) - this.x(from), 1.5);
      svg.append(svgElement("rect", { x: this.x(from), y, width, height: 11, rx: 2, class: "contact" }));
    }
  }

  show(time) {
    this.time = time;
    if (!this.cursor) return;
    this.cursor.setAttribute("x1", this.x(time));
    this.cursor.setAttribute("x2", this.x(time));
  }
}
