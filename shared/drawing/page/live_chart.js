// The contact force of the last seconds, as a line that moves on.

const LIVE_CHART_S = 20;

class LiveChart {
  constructor(host) {
    this.host = element("div", { class: "chart" });
    host.append(this.host);
    this.history = []; // of {time, force_N}, the newest last
    new ResizeObserver(() => this.draw()).observe(this.host);
  }

  add(time, force_N) {
    this.history.push({ time, force_N });
    const from = time - LIVE_CHART_S;
    while (this.history.length > 2 && this.history[1].time < from) this.history.shift();
  }

  draw() {
    const width = Math.max(this.host.clientWidth - 36, 240);
    const height = 150;
    const [left, bottom] = [58, height - 26];
    const end = this.history.length ? this.history[this.history.length - 1].time : 0;
    const most = Math.max(10, 1.1 * Math.max(...this.history.map((entry) => entry.force_N)));
    const x = (time) => left + ((width - left - 8) * (time - end + LIVE_CHART_S)) / LIVE_CHART_S;
    const y = (force) => bottom - ((bottom - 8) * force) / most;
    const svg = svgElement("svg", {
      role: "img",
      "aria-label": `Contact force over the last ${LIVE_CHART_S} s, at most ${most.toFixed(0)} N`,
      viewBox: `0 0 ${width} ${height}`,
      width,
      height,
      class: "forces",
    });
    const every = [2, 5, 10, 20, 50, 100, 200].find((step) => most / step < 5) || 500;
    for (let force = 0; force <= most; force += every) {
      svg.append(
        svgElement("line", { x1: left, x2: width - 8, y1: y(force), y2: y(force), class: "grid" }),
        svgElement("text", { x: left - 8, y: y(force) + 4, "text-anchor": "end" }, `${force} N`),
      );
    }
    for (const ago of [20, 15, 10, 5, 0]) {
      const text = ago === 0 ? "now" : `-${ago} s`;
      const anchor = ago === 0 ? "end" : "middle";
      svg.append(svgElement("text", { x: x(end - ago), y: height - 6, "text-anchor": anchor }, text));
    }
    const shown = this.history.filter((entry) => entry.time >= end - LIVE_CHART_S);
    const points = shown.map((entry) => `${x(entry.time).toFixed(1)},${y(entry.force_N).toFixed(1)}`);
    svg.append(svgElement("polyline", { points: points.join(" "), class: "curve" }));
    this.host.replaceChildren(svg);
  }
}
