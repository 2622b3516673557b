// Curves of a run over time, one under the other on one span of time: what is zoomed in one is in all.
// A click leads to that time, dragging across zooms, a double click shows the whole run again.

const PAPER_PX = 632; // of A4, within margins and frame

const PLOT_FONT = "12px system-ui, 'DejaVu Sans', sans-serif";

function colourOf(name) {
  return getComputedStyle(document.documentElement)
    .getPropertyValue("--" + name)
    .trim();
}

const OUTCOME_COLOURS = {
  contact: "contact",
  reached: "part",
  release: "goal",
  blocked: "wrong",
  timeout: "wrong",
};

// One plot with its heading and its legend.
class Plot {
  // series: {name, values, colour, dash, width, hidden, with, missing}; `with` names another one that it goes on and off
  // with, `missing` says what a moment without a value lacks.
  // draw: called with the plot between its grid and its curves; bare: without a grid.
  constructor(plots, { title, unit, digits, height, series, times, scale, range, draw, note, label, bare }) {
    Object.assign(this, { plots, unit, digits, height, series, times, draw, bare });
    this.key = element("div", { class: "legend curves-key" });
    this.canvas = element("div", { class: "plot" });
    this.heading = element("h3", {}, unit ? `${title} (${unit})` : title);
    this.box = element("div", { class: "plot-box" }, this.heading, this.key, this.canvas);
    if (note) this.box.append(element("p", { class: "note" }, note));
    plots.host.append(this.box);
    this.values = series.map((one) => this.keyFor(one));
    this.chart = new TenonLibraries.uPlot(this.options(scale, range), this.data(), this.canvas);
    this.chart.ctx.canvas.setAttribute("role", "img");
    this.chart.ctx.canvas.setAttribute("aria-label", label);
    this.listen();
  }

  data() {
    return [this.times, ...this.series.map((one) => one.values)];
  }

  options(scale, range) {
    const axis = (more) => ({
      stroke: () => colourOf("muted"),
      font: PLOT_FONT,
      grid: { stroke: () => colourOf("line"), width: 1 },
      ticks: { show: false },
      ...more,
    });
    return {
      width: this.plots.width(),
      height: this.height,
      legend: { show: false },
      scales: { x: { time: false }, y: { ...scale, ...(range ? { range } : {}) } },
      axes: this.bare
        ? [{ show: false }, axis({ size: 52, grid: { show: false }, values: () => [] })]
        : [
            axis({ size: 26, values: (_, ticks) => ticks.map((tick) => tick + " s") }),
            axis({
              size: 52,
              space: 24,
              values: (_, ticks) => ticks.map((tick) => this.nameOf(tick, scale)),
            }),
          ],
      padding: this.bare ? [4, 16, 4, 0] : [8, 16, 0, 0],
      cursor: { sync: { key: "run" }, y: false, points: { show: false }, drag: { x: true, y: false } },
      series: [
        {},
        ...this.series.map((one) => ({
          show: !one.hidden,
          stroke: () => colourOf(one.colour),
          width: one.width ?? 1.4,
          dash: one.dash,
          points: { show: false },
        })),
      ],
      hooks: {
        drawClear: [(chart) => this.plots.drawBands(chart)],
        drawAxes: [(chart) => inPlot(chart, (context, ratio) => this.draw?.(chart, context, ratio))],
        draw: [(chart) => this.plots.drawOver(chart)],
        setScale: [(chart, name) => name === "x" && this.plots.follow(chart)],
      },
    };
  }

  // Powers of ten are named on a logarithmic scale, and what any other scale has.
  nameOf(tick, scale) {
    if (tick === null || (scale?.distr === 3 && !Number.isInteger(Math.log10(tick)))) return "";
    return String(tick);
  }

  // Of a curve: its name, its value where the player is, and whether it is shown.
  keyFor(one) {
    const value = element("b");
    if (one.with !== undefined) return value;
    const sample = svgElement("svg", { width: 22, height: 10, viewBox: "0 0 22 10", "aria-hidden": "true" });
    sample.append(
      svgElement("path", {
        d: "M1 5h20",
        fill: "none",
        style: `stroke:var(--${one.colour})`,
        "stroke-width": 2.4,
        "stroke-dasharray": (one.dash || []).join(" "),
      }),
    );
    const box = element("input", { type: "checkbox" });
    box.checked = !one.hidden;
    box.addEventListener("change", () => {
      this.series.forEach((other, i) => {
        if (other === one || other.with === one.name) this.chart.setSeries(i + 1, { show: box.checked });
      });
    });
    this.key.append(element("label", { class: "key" }, box, sample, one.name, value));
    return value;
  }

  listen() {
    let from = null;
    this.chart.over.addEventListener("pointerdown", (event) => (from = event.clientX));
    this.chart.over.addEventListener("click", (event) => {
      if (from === null || Math.abs(event.clientX - from) > 4) return;
      const at = event.clientX - this.chart.over.getBoundingClientRect().left;
      this.plots.jump(this.chart.posToVal(at, "x"));
    });
  }

  resize() {
    this.chart.setSize({ width: this.plots.width(), height: this.height });
  }

  // What the curves are in the moment that holds the time.
  // @param why: in words, what the executor did instead, where a value is missing
  show(index, why) {
    this.series.forEach((one, i) => {
      const value = one.values[Math.min(index, one.values.length - 1)];
      const known = value !== null && value !== undefined;
      this.values[i].textContent = known ? `${fixed(value, this.digits)} ${this.unit}` : "–";
      this.values[i].title = known || !why ? "" : `${one.missing ?? "not known"}: ${why}`;
    });
  }

  destroy() {
    this.chart.destroy();
    this.box.remove();
  }
}

// Draws within the plot's frame.
function inPlot(chart, draw) {
  const { ctx: context, bbox } = chart;
  const ratio = window.devicePixelRatio || 1;
  context.save();
  context.beginPath();
  context.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  context.clip();
  draw(context, ratio);
  context.restore();
}

function horizontal(chart, context, ratio, { value, from, to, colour, dash, width = 1.2 }) {
  const y = chart.valToPos(value, "y", true);
  context.beginPath();
  context.setLineDash(dash.map((length) => length * ratio));
  context.lineWidth = width * ratio;
  context.strokeStyle = colourOf(colour);
  context.moveTo(from === undefined ? chart.bbox.left : chart.valToPos(from, "x", true), y);
  context.lineTo(to === undefined ? chart.bbox.left + chart.bbox.width : chart.valToPos(to, "x", true), y);
  context.stroke();
  context.setLineDash([]);
}

// All plots of a run.
class RunPlots {
  // spans: steps in time; faults: those whose time is known; jump: called with a time in s; why: of a time, in words
  // why nothing may be known.
  constructor(host, { spans, faults, end, jump, why }) {
    Object.assign(this, { spans, faults, end, jump, why });
    this.host = element("div");
    host.append(this.host);
    this.plots = [];
    this.time = 0;
    this.buildStrip();
    new ResizeObserver(() => this.resize()).observe(this.host);
    onColours(() => this.redraw());
    window.addEventListener("beforeprint", () => this.print(true));
    window.addEventListener("afterprint", () => this.print(false));
  }

  // On paper as wide as that is, dark on light. A canvas is printed as it was drawn before.
  print(onPaper) {
    this.onPaper = onPaper;
    document.documentElement.classList.toggle("paper", onPaper);
    this.resize();
    this.redraw();
  }

  width() {
    return this.onPaper ? PAPER_PX : Math.max(this.host.clientWidth, 280);
  }

  resize() {
    if (this.shownWidth === this.width()) return;
    this.shownWidth = this.width();
    for (const plot of this.all()) plot.resize();
  }

  redraw() {
    for (const plot of this.all()) plot.chart.redraw();
  }

  all() {
    return [this.strip, ...this.plots].filter(Boolean);
  }

  add(description) {
    const plot = new Plot(this, description);
    this.plots.push(plot);
    return plot;
  }

  // Another curve in a plot's place.
  replace(plot, description) {
    const before = plot.box.nextSibling;
    const { min, max } = plot.chart.scales.x;
    plot.destroy();
    const made = new Plot(this, description);
    if (before) this.host.insertBefore(made.box, before);
    this.plots[this.plots.indexOf(plot)] = made;
    made.chart.setScale("x", { min, max });
    return made;
  }

  // The steps as bands, by outcome.
  buildStrip() {
    const buttons = element("div", { class: "zoom", role: "group", "aria-label": "Span of time" });
    const button = (text, title, action) => {
      const made = element("button", { type: "button", title }, text);
      made.addEventListener("click", action);
      buttons.append(made);
    };
    button("Whole run", "Show the curves of the whole run", () => this.zoom(0, this.end));
    button("This step", "Show the curves of the step where the player is", () => this.zoomToStep());
    this.host.append(buttons);
    const told = this.spans.map(
      (span) => `step ${span.step} ${span.outcome || "unfinished"} until ${span.to_s.toFixed(1)} s`,
    );
    this.strip = new Plot(this, {
      title: "Steps",
      bare: true,
      height: 42,
      series: [{ name: "", values: [null, null], colour: "ink", with: "" }],
      times: [0, this.end],
      range: () => [0, 1],
      label: "Steps over time: " + told.join(", "),
      digits: 0,
      unit: "",
      draw: (chart, context, ratio) => this.drawStrip(chart, context, ratio),
    });
    this.strip.canvas.classList.add("strip");
  }

  drawStrip(chart, context, ratio) {
    const { top, height } = chart.bbox;
    const edge = 4 * ratio;
    for (const span of this.spans) {
      const left = chart.valToPos(span.from_s, "x", true);
      const width = Math.max(chart.valToPos(span.to_s, "x", true) - left - ratio, ratio);
      const colour = colourOf(span.deviation ? "bad" : OUTCOME_COLOURS[span.outcome] || "muted");
      context.fillStyle = colourOf("soft");
      context.fillRect(left, top, width, height);
      context.fillStyle = colour;
      context.fillRect(left, top + height - edge, width, edge);
      this.nameBand(context, ratio, span, { left, width, middle: top + (height - edge) / 2 });
    }
  }

  // As many words as there is room for.
  nameBand(context, ratio, span, { left, width, middle }) {
    context.font = PLOT_FONT.replace("12px", 12 * ratio + "px");
    context.textBaseline = "middle";
    context.textAlign = "center";
    context.fillStyle = colourOf(span.deviation ? "bad" : "ink");
    const sign = span.deviation ? "! " : "";
    const texts = [`${sign}${span.step} ${span.outcome || "unfinished"}`, sign + span.step];
    const text = texts.find((one) => context.measureText(one).width < width - 4 * ratio);
    if (text) context.fillText(text, left + width / 2, middle);
  }

  // Every second step darker, so that one sees where they meet.
  drawBands(chart) {
    inPlot(chart, (context) => {
      context.fillStyle = colourOf("soft");
      this.spans.forEach((span, i) => {
        if (i % 2) return;
        const left = chart.valToPos(span.from_s, "x", true);
        context.fillRect(
          left,
          chart.bbox.top,
          chart.valToPos(span.to_s, "x", true) - left,
          chart.bbox.height,
        );
      });
    });
  }

  // Where the player is, and where something went wrong.
  drawOver(chart) {
    inPlot(chart, (context, ratio) => {
      const line = (time, colour, dash, width) => {
        const x = chart.valToPos(time, "x", true);
        context.beginPath();
        context.setLineDash(dash);
        context.lineWidth = width * ratio;
        context.strokeStyle = colourOf(colour);
        context.moveTo(x, chart.bbox.top);
        context.lineTo(x, chart.bbox.top + chart.bbox.height);
        context.stroke();
      };
      for (const fault of this.faults) line(fault.time_s, "bad", [5 * ratio, 3 * ratio], 2);
      line(this.time, "accent", [], 1.6);
    });
  }

  // Zoomed in one, zoomed in all.
  follow(chart) {
    if (this.following) return;
    const { min, max } = chart.scales.x;
    const whole = Math.abs(max - min - this.end) < 1e-6;
    document.documentElement.dataset.zoom = whole ? "all" : JSON.stringify([min, max]);
    this.following = true;
    for (const plot of this.all()) if (plot.chart !== chart) plot.chart.setScale("x", { min, max });
    this.following = false;
  }

  zoom(from, to) {
    this.strip.chart.setScale("x", { min: from, max: to });
  }

  zoomToStep() {
    const span =
      this.spans.find((one) => this.time >= one.from_s && this.time <= one.to_s) ||
      this.spans.findLast((one) => one.from_s <= this.time) ||
      this.spans[0];
    if (!span) return;
    const rim = 0.03 * Math.max(span.to_s - span.from_s, 0.05);
    this.zoom(Math.max(0, span.from_s - rim), Math.min(this.end, span.to_s + rim));
  }

  show(time) {
    this.time = time;
    for (const plot of this.plots) plot.show(momentAt(plot.times, time), this.why(time));
    this.redrawSoon();
  }

  // Once a frame, however often the time changes.
  redrawSoon() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      for (const plot of this.all()) plot.chart.redraw(false, false);
    });
  }
}
