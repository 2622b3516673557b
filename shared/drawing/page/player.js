// Time over what a page plays: play, step, scrub, by mouse and keys. Tells its listener of every change.
// Its unit is the page's: moves of a plan, or seconds of a run.

const SECONDS_PER_MOVE = 1.4;
const LEAP_MS = 1000; // at most, from one picture to the next

// Drawn and not written: not every font has these signs.
function iconOf(path) {
  const icon = svgElement("svg", { viewBox: "0 0 16 16", width: 14, height: 14, "aria-hidden": "true" });
  icon.append(svgElement("path", { d: path, fill: "currentColor" }));
  return icon;
}

class Player {
  // what: the name of what is played, such as "plan".
  constructor(what, listener) {
    this.what = what;
    this.listener = listener;
    this.end = 0;
    this.time = 0;
    this.playing = false;
    this.speed = 1;
    this.controls = this.buildControls();
    this.setSpan({ stops: [0], perSecond: 1, nameOf: () => "" });
    document.addEventListener("keydown", (event) => this.onKey(event));
  }

  // stops: ascending, from 0 to the end, where single steps lead to; perSecond: units in a second of play;
  // nameOf: a time in words.
  setSpan({ stops, perSecond, nameOf }) {
    this.stops = stops;
    this.end = stops[stops.length - 1];
    this.perSecond = perSecond;
    this.nameOf = nameOf;
    this.range.max = this.end;
    this.ticks.replaceChildren(
      ...stops.map((stop) => element("i", { style: `left:${((100 * stop) / (this.end || 1)).toFixed(2)}%` })),
    );
  }

  button(icon, title, action) {
    const made = element("button", { type: "button", title, "aria-label": title });
    if (icon) made.append(iconOf(icon));
    made.addEventListener("click", action);
    return made;
  }

  buildControls() {
    this.playButton = this.button("", "Play", () => this.toggle());
    this.playButton.classList.add("play");
    this.range = element("input", { type: "range", min: 0, max: 1, step: 0.01, value: 0 });
    this.range.setAttribute("aria-label", "Step of the " + this.what);
    this.range.addEventListener("input", () => {
      this.pause();
      this.set(Number(this.range.value));
    });
    this.ticks = element("div", { class: "ticks", "aria-hidden": "true" });
    this.select = element("select", { "aria-label": "Speed of the play" });
    for (const speed of [0.25, 0.5, 1, 2, 4]) {
      this.select.append(element("option", { value: speed }, speed + "×"));
    }
    this.select.value = "1";
    this.select.addEventListener("change", () => (this.speed = Number(this.select.value)));
    return element(
      "div",
      { class: "controls", role: "group", "aria-label": "Play the " + this.what },
      this.button("M2 2h2v12h-2zM14 2v12l-9 -6z", "To the start (Home)", () => this.jump(0)),
      this.button("M12 2v12l-9 -6z", "One step back (left arrow)", () => this.step(-1)),
      this.playButton,
      this.button("M4 2v12l9 -6z", "One step on (right arrow)", () => this.step(+1)),
      this.button("M12 2h2v12h-2zM2 2v12l9 -6z", "To the end (End)", () => this.jump(this.end)),
      element("div", { class: "scrub" }, this.range, this.ticks),
      this.select,
    );
  }

  // Whether the key is for the element that has the focus. The player's own slider goes from step to step as the page
  // does.
  belongs(key, target) {
    const { tagName, type } = target;
    if (target === this.range) return false;
    if (["SELECT", "TEXTAREA"].includes(tagName) || (tagName === "INPUT" && type !== "checkbox")) return true;
    return key === " " && ["BUTTON", "SUMMARY", "INPUT"].includes(tagName);
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const actions = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.step(-1),
      ArrowRight: () => this.step(+1),
      Home: () => this.jump(0),
      End: () => this.jump(this.end),
    };
    if (!(event.key in actions) || this.belongs(event.key, event.target)) return;
    event.preventDefault();
    actions[event.key]();
  }

  set(time) {
    this.time = Math.max(0, Math.min(this.end, time));
    this.range.value = this.time;
    this.range.setAttribute("aria-valuetext", this.nameOf(this.time));
    this.listener(this.time, this.playing);
  }

  jump(time) {
    this.pause();
    this.set(time);
  }

  step(by) {
    const after = this.stops.find((stop) => stop > this.time + 1e-6);
    const before = this.stops.findLast((stop) => stop < this.time - 1e-6);
    this.jump(by > 0 ? (after ?? this.end) : (before ?? 0));
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.time >= this.end) this.set(0);
    this.playing = true;
    this.showState();
    let last = null;
    const frame = (now) => {
      if (!this.playing) return;
      // A browser that draws slowly shows fewer pictures, not slower ones; one that slept does not leap.
      const elapsed = last === null ? 0 : Math.min(now - last, LEAP_MS);
      last = now;
      this.set(this.time + 1e-3 * elapsed * this.perSecond * this.speed);
      if (this.time >= this.end) this.pause();
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  pause() {
    this.playing = false;
    this.showState();
  }

  showState() {
    const title = this.playing ? "Pause (space)" : "Play (space)";
    this.playButton.textContent = this.playing ? "Pause" : "Play";
    this.playButton.setAttribute("title", title);
    this.playButton.setAttribute("aria-label", title);
    document.documentElement.dataset.playing = this.playing;
  }
}
