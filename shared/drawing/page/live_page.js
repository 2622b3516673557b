// A cell as it is now: its server sends moments as they happen, and the page draws the newest.

const LIVE_STATES = {
  waiting: "Waiting for the first moment",
  live: "Running",
  silent: "No word from the simulation",
  lost: "Connection lost",
  full: "Too many look on already",
  ended: "The simulation has ended",
};
const TRACK_STEP_M = 2e-4;
const TRACK_MAX = 4000;
const FLASH_MS = 600;
const TOUCH_PAUSE_S = 0.3; // a contact that was away for less is the same one
const SILENT_MS = 1500;
const TELL_MS = 100;

class LivePage {
  constructor(data) {
    this.data = data;
    this.options = { particles: false, draws: false, paths: true, cut: hidesGoal(data) };
    this.moment = null;
    this.track = [];
    this.flashes = [];
    this.touchedAt_s = new Map();
    this.count = 0;
    this.heard_ms = 0;
    this.told_ms = 0;
    this.prepare();
    this.buildStage(document.querySelector("[data-part=stage]"));
    this.buildForces(document.querySelector("[data-part=forces]"));
    this.setState("waiting");
    this.draw();
    this.connect();
    setInterval(() => this.watch(), 500);
    document.documentElement.dataset.ready = "true";
  }

  // What the scene needs beside the data of the page itself.
  prepare() {
    const { data } = this;
    const [x, y, z, w, ...turn] = data.nominal;
    if (Math.hypot(x, y, z, ...turn) < 1e-6) data.nominal = null;
    Object.assign(data, { particles: [], draws: [], reached: [] });
    for (const shape of data.nominal ? data.scene.environment : []) {
      for (let i = 0; i < shape.points_m.length; i += 3) {
        data.reached.push(placed(data.nominal, shape.points_m.slice(i, i + 3)));
      }
    }
    const { low, high } = boundsOf(data);
    this.size_m = Math.hypot(...high.map((value, i) => value - low[i]));
    this.most_N = 20;
  }

  buildStage(host) {
    const legend = element(
      "div",
      { class: "legend" },
      keyOf("part", "the part"),
      keyOf("ink", "its path, and the force on it"),
      keyOf("goal", "goal"),
      keyOf("contact", "touched"),
    );
    if (this.data.nominal) legend.append(keyOf("muted", "where the robot believes it to be"));
    legend.append(cutBox(this.options, () => this.draw()));
    this.stage = new Stage(host, this.data, [], legend);
    this.heading = element("h2", { "aria-live": "polite" });
    this.words = element("div", { class: "words" });
    this.stage.now.append(this.heading, this.words);
  }

  buildForces(host) {
    this.chart = new LiveChart(host);
    host.append(
      element("p", { class: "note" }, "The largest force on the part in each fiftieth of a second."),
    );
  }

  connect() {
    const source = new EventSource("events");
    source.addEventListener("path", (event) => this.begin(JSON.parse(event.data)));
    source.addEventListener("message", (event) => this.take(JSON.parse(event.data)));
    source.addEventListener("end", (event) => {
      source.close();
      this.ending = JSON.parse(event.data);
      this.setState("ended");
      this.draw();
    });
    source.addEventListener("error", () => {
      if (this.state === "ended") return;
      // It tries again by itself, unless it was refused.
      const refused = source.readyState === EventSource.CLOSED;
      this.setState(refused ? "full" : "lost");
      if (refused) setTimeout(() => this.connect(), 3000);
    });
  }

  // The path so far of the run that is looked at; where another one answers, the page is that one's.
  begin({ run_id, path }) {
    if (run_id !== this.data.run_id) {
      location.reload();
      return;
    }
    this.track = [];
    for (let i = 0; i < path.length; i += 3) this.track.push(path.slice(i, i + 3));
  }

  take(moment) {
    this.moment = moment;
    this.heard_ms = performance.now();
    ++this.count;
    const last = this.track[this.track.length - 1];
    const at = moment.tool.slice(0, 3);
    if (!last || Math.hypot(...at.map((value, i) => value - last[i])) >= TRACK_STEP_M) this.track.push(at);
    if (this.track.length > TRACK_MAX) this.track = this.track.filter((_, i) => i % 2 === 0);
    this.noteTouches(moment);
    this.most_N = Math.max(this.most_N, moment.force_N_max);
    this.chart.add(moment.time_s, moment.force_N_max);
    if (this.state !== "live") this.setState("live");
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      const looks = JSON.stringify({ ...this.moment, time_s: 0 });
      this.draw(looks !== this.looks || this.flashes.length > 0);
      this.looks = looks;
    });
  }

  // A flash where something begins to be touched.
  noteTouches({ touched, time_s, points }) {
    for (const index of touched) {
      const before = this.touchedAt_s.get(index);
      if ((before === undefined || time_s - before > TOUCH_PAUSE_S) && points.length > 0) {
        this.flashes.push({ at: meanOf(points), from_ms: performance.now() });
      }
      this.touchedAt_s.set(index, time_s);
    }
  }

  // Whether moments still come.
  watch() {
    if (this.state === "live" && performance.now() - this.heard_ms > SILENT_MS) this.setState("silent");
  }

  setState(state) {
    this.state = state;
    this.heading.textContent = LIVE_STATES[state];
    this.heading.dataset.state = state;
    document.documentElement.dataset.state = state;
    this.tell();
  }

  stateNow() {
    const now_ms = performance.now();
    this.flashes = this.flashes.filter((flash) => now_ms - flash.from_ms < FLASH_MS);
    const growing = this.flashes.map(({ at, from_ms }) => ({ at, age: (now_ms - from_ms) / FLASH_MS }));
    const { moment } = this;
    if (!moment) return { ...emptyState(NO_TRAILS), track: this.track };
    return {
      ...emptyState(NO_TRAILS),
      front: moment.tool,
      track: [...this.track, moment.tool],
      touched: new Set(moment.touched.map((index) => this.data.scene.environment[index].name)),
      flashes: [...growing, ...moment.points.map((at) => ({ at, age: 0 }))],
      arrow: this.arrowOf(moment),
    };
  }

  // The force on the part, from where it acts; the largest so far is a fifth of the picture.
  arrowOf({ points, force_N }) {
    if (points.length === 0 || Math.hypot(...force_N) < 0.05) return null;
    const scale = (0.2 * this.size_m) / this.most_N;
    return { from: meanOf(points), along: force_N.map((value) => scale * value) };
  }

  // Words and the force's line change too fast to be read otherwise; at rest the picture stays as it is.
  draw(moves = true) {
    if (moves) this.stage.picture.draw(this.stateNow(), this.options);
    if (this.state !== "live" || performance.now() - this.told_ms > TELL_MS) {
      this.chart.draw();
      this.tell();
    }
    const { moment } = this;
    if (!moment) return;
    Object.assign(document.documentElement.dataset, {
      time: moment.time_s,
      tool: JSON.stringify(moment.tool),
      moments: this.count,
      enabled: moment.enabled,
      points: moment.points.length,
    });
  }

  tell() {
    this.told_ms = performance.now();
    const { moment, data } = this;
    const told = this.state === "ended" && this.ending.time_s !== undefined;
    const lines = told ? this.endingLines() : [];
    if (this.state === "lost") {
      lines.push(element("p", { class: "note" }, "It ended without a word, or was stopped. Trying again."));
    }
    if (moment && !told) lines.push(...this.motionLines(moment, data));
    if (moment) lines.push(...this.momentLines(moment, data));
    this.words.replaceChildren(...lines);
  }

  motionLines(moment, { goal }) {
    const way = Math.hypot(...goal.slice(0, 3).map((value, i) => value - moment.tool[i]));
    return [
      termLine("Time", `${moment.time_s.toFixed(1)} s`),
      termLine("From the goal", amount(way, 0)),
      termLine("Contact force", `${moment.force_N_max.toFixed(1)} N`),
    ];
  }

  momentLines(moment, { drives, scene }) {
    const names = [...new Set(moment.touched.map((index) => scene.environment[index].name))];
    const brakes = moment.braked === 0 ? "released" : `${moment.braked} of ${drives} engaged`;
    const lines = [
      termLine("Drives", `${moment.enabled} of ${drives} enabled`),
      termLine("Brakes", brakes),
      termLine("Touches", names.length ? names.join(", ") : "nothing"),
    ];
    if (moment.faulted) lines.push(termLine("Faults", `${moment.faulted} of ${drives} drives`));
    if (moment.dropped) lines.push(termLine("Moments dropped", moment.dropped));
    return lines;
  }

  endingLines() {
    const { error_m, within_tolerance, contact_force_N_max, time_s } = this.ending;
    const verdict = within_tolerance ? "At the goal" : "Not at the goal";
    return [
      element("p", { class: "move" }, verdict),
      termLine("From it", `${amount(error_m, 0)} (${amount(this.data.goal_tolerance_m, 0)} allowed)`),
      termLine("Largest force", `${contact_force_N_max.toFixed(1)} N in ${time_s.toFixed(1)} s`),
    ];
  }
}
