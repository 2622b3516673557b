// The scene as flat SVG along one axis of the task frame, in millimetres: where there is no WebGL, or not yet.

const SVG_NAMESPACE = "http://www.w3.org/2000/svg";

function svgElement(name, attributes = {}, ...children) {
  const element = document.createElementNS(SVG_NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

// Smaller than it might be, by this factor at most, so that what stands still is nearer to the middle.
const SMALLER_MOST = 1.2;

// The interval of this length nearest about a middle that holds another, which is no longer.
function intervalAbout(middle, length, [low, high]) {
  const begin = Math.min(low, Math.max(high - length, middle - length / 2));
  return [begin, begin + length];
}

class SvgScene {
  constructor(host, data, bounds, palette) {
    this.host = host;
    this.data = data;
    this.bounds = bounds;
    const still = boundsOf({ ...data, particles: [], reached: [] });
    this.still = still.points.length ? still : bounds;
    this.svg = svgElement("svg", {
      role: "img",
      "aria-label": "The part, its particles and the environment",
    });
    host.append(this.svg);
    this.view = data.views[0];
    this.recolour(palette);
  }

  at(point) {
    return [1e3 * point[this.view.right], -1e3 * point[this.view.up]];
  }

  // The shadow of triangles: all wound the same way, so that together they fill what any of them covers.
  shadow(shape, pose) {
    const points = [];
    for (let i = 0; i < shape.points_m.length; i += 3) {
      const point = shape.points_m.slice(i, i + 3);
      points.push(this.at(pose ? placed(pose, point) : point));
    }
    let path = "";
    for (let i = 0; i < shape.triangles.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => points[shape.triangles[i + k]]);
      const turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
      if (turn === 0) continue;
      const corners = turn > 0 ? [a, b, c] : [a, c, b];
      path += "M" + corners.map((p) => p[0].toFixed(2) + "," + p[1].toFixed(2)).join("L") + "Z";
    }
    return path;
  }

  recolour(palette) {
    this.palette = palette;
    this.build();
    if (this.last) this.draw(...this.last);
  }

  setView(view) {
    this.view = view;
    this.build();
    if (this.last) this.draw(...this.last);
  }

  // Seen along the view: what of a box is from left to right, and from top to bottom.
  seen({ low, high }) {
    const [left, bottom] = this.at(low);
    const [right, top] = this.at(high);
    return [
      [left, right],
      [top, bottom],
    ];
  }

  // All that is ever drawn, with the environment and the part at its start and goal as near to the middle of the host
  // as can be: the part may go far to one side of them.
  frame() {
    const within = this.seen(this.bounds);
    this.size = Math.max(...within.map(([low, high]) => high - low));
    const rim = 0.03 * this.size;
    const all = within.map(([low, high]) => [low - rim, high + rim]);
    const middles = this.seen(this.still).map(([low, high]) => (low + high) / 2);
    const lengths = all.map(([low, high], i) =>
      Math.min(SMALLER_MOST * (high - low), 2 * Math.max(high - middles[i], middles[i] - low)),
    );
    const { clientWidth, clientHeight } = this.host;
    const shape = clientWidth && clientHeight ? clientWidth / clientHeight : lengths[0] / lengths[1];
    const height = Math.max(lengths[1], lengths[0] / shape);
    const [x, y] = [height * shape, height].map((length, i) => intervalAbout(middles[i], length, all[i]));
    const box = [x[0], y[0], x[1] - x[0], y[1] - y[0]];
    this.svg.setAttribute("viewBox", box.map((value) => value.toFixed(2)).join(" "));
  }

  build() {
    this.frame();
    this.environment = this.data.scene.environment.map((shape) => ({
      name: shape.name,
      path: svgElement("path", { d: this.shadow(shape), "fill-opacity": 0.45 }),
    }));
    const goal = this.data.scene.held.map((shape) =>
      svgElement("path", {
        d: this.shadow(shape, this.data.goal),
        fill: this.palette.goal,
        "fill-opacity": 0.35,
      }),
    );
    const nominal = (this.data.nominal ? this.data.scene.environment : []).map((shape) =>
      svgElement("path", {
        d: this.shadow(shape, this.data.nominal),
        fill: this.palette.muted,
        "fill-opacity": 0.14,
      }),
    );
    this.trails = svgElement("g");
    this.shownTrails = NO_TRAILS;
    this.moving = svgElement("g");
    const still = this.environment.map((entry) => entry.path);
    this.svg.replaceChildren(...nominal, ...still, ...goal, this.trails, this.moving);
  }

  part(pose, attributes) {
    return this.data.scene.held.map((shape) =>
      svgElement("path", { d: this.shadow(shape, pose), ...attributes }),
    );
  }

  line(points, attributes) {
    const list = points
      .map((point) =>
        this.at(point)
          .map((value) => value.toFixed(2))
          .join(","),
      )
      .join(" ");
    return svgElement("polyline", { points: list, fill: "none", ...attributes });
  }

  dot(point, radius, attributes) {
    const [cx, cy] = this.at(point);
    return svgElement("circle", { cx, cy, r: radius * this.size, ...attributes });
  }

  // An arm may go where nobody foresaw. True: the picture has to become larger.
  outgrown(pose) {
    const { low, high } = this.bounds;
    const inside = pose.slice(0, 3).every((value, i) => value >= low[i] && value <= high[i]);
    if (inside) return false;
    const held = this.data.scene.held.flatMap((shape) => shape.points_m.map(Math.abs));
    const reach = held.reduce((most, value) => Math.max(most, value), 0);
    const lower = low.map((value, i) => Math.min(value, pose[i] - reach));
    const upper = high.map((value, i) => Math.max(value, pose[i] + reach));
    this.bounds = { ...this.bounds, low: lower, high: upper };
    return true;
  }

  draw(state, options) {
    this.last = [state, options];
    if (state.front && !state.trails.length && this.outgrown(state.front)) this.build();
    const colour = this.palette;
    const unit = this.size;
    for (const { name, path } of this.environment) {
      path.setAttribute("fill", state.touched.has(name) ? colour.contact : colour.environment);
    }
    const elements = [];
    if (options.draws) {
      for (const pose of state.draws)
        elements.push(this.dot(pose, 0.0025, { fill: colour.muted, "fill-opacity": 0.5 }));
    }
    if (options.particles) {
      for (const pose of state.particles) {
        elements.push(...this.part(pose, { fill: colour.particle, "fill-opacity": 0.1 }));
      }
    }
    if (state.track.length) {
      elements.push(this.line(state.track, { stroke: colour.ink, "stroke-width": 0.0035 * unit }));
    }
    if (state.front) elements.push(...this.part(state.front, { fill: colour.part, "fill-opacity": 0.55 }));
    const move = Math.floor(state.time);
    if (options.paths) {
      this.data.particles.forEach((chain, i) => {
        const points = [...chain.poses.slice(0, move + 1), state.particles[i]];
        elements.push(this.line(points, { stroke: colour.particle, "stroke-width": 0.0025 * unit }));
      });
    }
    for (const pose of state.particles) elements.push(this.dot(pose, 0.006, { fill: colour.particle }));
    elements.push(...this.whiskersOf(state), ...this.arrowOf(state));
    for (const flash of state.flashes) {
      const ring = {
        fill: "none",
        stroke: colour.contact,
        "stroke-opacity": 1 - flash.age,
        "stroke-width": 0.005 * unit,
      };
      elements.push(this.dot(flash.at, 0.012 + 0.04 * flash.age, ring));
    }
    this.drawTrails(options.paths ? state.trails : NO_TRAILS);
    this.moving.replaceChildren(...elements);
  }

  // Paths of runs and the marks at their ends, by outcome.
  drawTrails(trails) {
    if (trails === this.shownTrails) return;
    this.shownTrails = trails;
    const flat = (points, join) =>
      points
        .map((point) =>
          this.at(point)
            .map((value) => value.toFixed(2))
            .join(","),
        )
        .join(join);
    const drawn = TRAIL_CLASSES.flatMap((name) => {
      const own = trails.filter((trail) => trail.class === name);
      const ends = own.flatMap((trail) =>
        trailMark(name, trail.points[trail.points.length - 1], 8e-6 * this.size),
      );
      const marks = [];
      for (let i = 0; i < ends.length; i += 2) marks.push("M" + flat(ends.slice(i, i + 2), "L"));
      const path = (d, width, opacity) =>
        svgElement("path", {
          d,
          fill: "none",
          stroke: this.palette[name],
          "stroke-opacity": opacity,
          "stroke-width": width * this.size,
        });
      return [
        path(
          own.map((trail) => "M" + flat(trail.points, "L")).join(""),
          0.0018,
          name === "succeeded" ? 0.35 : 0.75,
        ),
        path(marks.join(""), 0.003, 1),
      ];
    });
    this.trails.replaceChildren(...drawn);
  }

  // Two standard deviations each way along the axes that are seen.
  whiskersOf({ mean, spread }) {
    if (!spread) return [];
    const end = (axis, sigmas) =>
      mean.map((value, i) => (i === axis ? value + sigmas * spread[axis] : value));
    const style = { stroke: this.palette.ink, "stroke-width": 0.003 * this.size, class: "whisker" };
    return [this.view.right, this.view.up]
      .filter((axis) => spread[axis] > 0)
      .map((axis) => this.line([end(axis, -2), end(axis, 2)], style));
  }

  arrowOf(state) {
    if (!state.arrow) return [];
    const { from, along } = state.arrow;
    const flat = [along[this.view.right], along[this.view.up]];
    const length = Math.hypot(...flat);
    if (length === 0) return [];
    const scale = Math.min(1, (0.22 * this.size) / (1e3 * length));
    const to = from.map((value, i) => value + scale * along[i]);
    const [x, y] = this.at(to);
    const angle = (Math.atan2(-flat[1], flat[0]) * 180) / Math.PI;
    const size = 0.02 * this.size;
    const head = svgElement("path", {
      d: `M0,${-size / 2}L${size},0L0,${size / 2}Z`,
      transform: `translate(${x} ${y}) rotate(${angle})`,
      fill: this.palette.arrow,
    });
    return [this.line([from, to], { stroke: this.palette.arrow, "stroke-width": 0.006 * this.size }), head];
  }

  dispose() {
    this.svg.remove();
  }
}
