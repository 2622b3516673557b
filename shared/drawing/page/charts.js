// The uncertainty of each direction over the steps: one row a direction, on a logarithmic scale.

class UncertaintyChart {
  constructor(host, data, jump) {
    this.host = host;
    this.data = data;
    this.jump = jump;
    this.time = 0;
    this.build();
    new ResizeObserver(() => this.build()).observe(host);
  }

  rows() {
    const { nodes, coordinates } = this.data;
    const rows = coordinates.map((axis) => ({
      label: AXES[axis],
      values: nodes.map((node) => node.spread[axis]),
      text: (value) => smallAmount(value, axis),
      axis,
    }));
    if (coordinates.length > 1) {
      rows.push({
        label: "all",
        values: nodes.map((node) => node.uncertainty_m),
        text: (value) => smallAmount(value, 0),
        wanted: this.data.goal_uncertainty_m,
      });
    }
    return rows;
  }

  build() {
    const width = Math.max(this.host.clientWidth, 280);
    if (this.data.nodes.length === 0 || width === this.width) return;
    this.width = width;
    const rows = this.rows();
    const height = 62;
    const left = 44;
    const right = 92;
    const count = this.data.nodes.length - 1;
    this.x = (time) => left + ((width - left - right) * time) / Math.max(count, 1);
    const bottom = rows.length * height;
    const label =
      "Standard deviation of each direction after each step, from " + rows.map((row) => row.label).join(", ");
    const svg = svgElement("svg", {
      role: "img",
      "aria-label": label,
      viewBox: `0 0 ${width} ${bottom + 26}`,
      width,
      height: bottom + 26,
      class: "uncertainty",
    });
    for (let i = 0; i <= count; ++i) {
      svg.append(svgElement("line", { x1: this.x(i), x2: this.x(i), y1: 6, y2: bottom, class: "grid" }));
      const every = Math.ceil(count / ((width - left - right) / 30));
      if (i % every === 0) {
        const text = i === 0 ? "start" : String(i - 1);
        svg.append(
          svgElement("text", { x: this.x(i), y: bottom + 18, class: "tick", "text-anchor": "middle" }, text),
        );
      }
    }
    rows.forEach((row, i) => this.buildRow(svg, row, i * height, height));
    this.cursor = svgElement("line", { y1: 0, y2: bottom, class: "cursor" });
    svg.append(this.cursor);
    svg.addEventListener("click", (event) => {
      const at = event.clientX - svg.getBoundingClientRect().left;
      this.jump(Math.round(((at - left) / (width - left - right)) * count));
    });
    this.host.replaceChildren(svg);
    this.show(this.time);
  }

  buildRow(svg, row, top, height) {
    const most = Math.max(...row.values, row.wanted || 0, 1e-9);
    const least = Math.max(most * 1e-3, 1e-7);
    const y = (value) =>
      top + 14 + (height - 26) * (1 - Math.log(Math.max(value, least) / least) / Math.log(most / least));
    const points = row.values.map((value, i) => this.x(i) + "," + y(value).toFixed(1)).join(" ");
    const first = row.values[0];
    const last = row.values[row.values.length - 1];
    svg.append(
      svgElement("line", {
        x1: this.x(0),
        x2: this.x(row.values.length - 1),
        y1: y(least),
        y2: y(least),
        class: "base",
      }),
    );
    if (row.wanted) {
      svg.append(
        svgElement("line", {
          x1: this.x(0),
          x2: this.x(row.values.length - 1),
          y1: y(row.wanted),
          y2: y(row.wanted),
          class: "wanted",
        }),
      );
    }
    svg.append(
      svgElement("text", { x: 0, y: top + height / 2 + 5, class: "label" }, row.label),
      svgElement("polyline", { points, class: "curve" }),
      svgElement(
        "text",
        { x: this.x(row.values.length - 1) + 10, y: y(last) + 4, class: "value" },
        row.text(last),
      ),
      svgElement("text", { x: this.x(0) + 7, y: y(first) - 3, class: "value" }, row.text(first)),
    );
    row.values.forEach((value, i) => {
      const gain = i > 0 && row.axis !== undefined && this.gainOf(i - 1, row.axis);
      const mark = svgElement("circle", {
        cx: this.x(i),
        cy: y(value),
        r: gain ? 4.5 : 2.2,
        class: gain ? "gain" : "node",
      });
      const why = gain ? ": " + gain.why : "";
      const when = i === 0 ? "start" : "step " + (i - 1);
      mark.append(svgElement("title", {}, `${row.label} ${row.text(value)}, ${when}${why}`));
      svg.append(mark);
    });
  }

  gainOf(step, axis) {
    return (this.data.steps[step].gains || []).find((gain) => gain.axis === axis);
  }

  show(time) {
    this.time = time;
    if (!this.cursor) return;
    const x = this.x(Math.min(time, this.data.nodes.length - 1));
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
  }
}
