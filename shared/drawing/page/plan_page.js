// The plan's page: the scene with its player, what happens now in words, and the uncertainty.

class PlanPage {
  constructor(data) {
    this.data = data;
    this.options = { particles: true, paths: true, draws: true, cut: hidesGoal(data) };
    this.chains = data.draws.length ? data.draws : data.particles;
    this.focus = this.chains[0];
    this.buildStage(document.querySelector("[data-part=stage]"));
    const chart = document.querySelector("[data-part=uncertainty]");
    this.chart = new UncertaintyChart(chart, data, (time) => this.player.jump(time));
    for (const button of document.querySelectorAll("button.jump")) {
      button.addEventListener("click", () => this.show(Number(button.dataset.step)));
    }
    document.addEventListener("keydown", (event) => {
      if (event.key === "r" && !event.ctrlKey && !event.metaKey) this.another();
    });
    this.begin();
  }

  show(time) {
    this.player.jump(time);
    this.stage.comeIntoView();
  }

  begin() {
    const asked = /step=([\d.]+)/.exec(location.hash);
    this.player.jump(asked ? Number(asked[1]) : 0);
    if (!asked && !wantsNoMotion()) this.player.play();
    document.documentElement.dataset.ready = "true";
  }

  buildStage(host) {
    const count = this.data.steps.length;
    const stops = Array.from({ length: count + 1 }, (_, i) => i);
    this.player = new Player("plan", (time) => this.update(time));
    this.player.setSpan({
      stops,
      perSecond: 1 / SECONDS_PER_MOVE,
      nameOf: (time) => (time >= count ? "end" : "step " + Math.floor(time)),
    });
    this.stage = new Stage(host, this.data, [this.player.controls], this.buildLegend());
    this.picture = this.stage.picture;
    this.now = this.stage.now;
    this.buildNow();
  }

  buildLegend() {
    const count = this.data.particles.length;
    const box = (name, colour, text) =>
      optionBox(this.options, name, colour, text, () => this.update(this.player.time));
    const random = element("button", { type: "button", class: "random", title: "Another random start (R)" });
    random.append("Another start");
    random.addEventListener("click", () => this.another());
    this.frontText = element("span");
    const legend = element(
      "div",
      { class: "legend" },
      keyOf("part", this.frontText),
      this.data.draws.length ? random : null,
      box("particles", "particle", count + (count === 1 ? " particle" : " particles")),
      box("paths", "particle", "paths"),
      this.data.draws.length ? box("draws", "muted", this.data.draws.length + " random starts") : null,
      keyOf("goal", "goal"),
      keyOf("contact", "touched"),
      cutBox(this.options, () => this.update(this.player.time)),
    );
    this.nameFront();
    return legend;
  }

  nameFront() {
    const chain = this.focus;
    this.frontText.textContent =
      chain.out === undefined ? "particle 0" : `random start ${this.data.draws.indexOf(chain)}, ${chain.out}`;
  }

  another() {
    if (!this.data.draws.length) return;
    const others = this.data.draws.filter((chain) => chain !== this.focus);
    if (others.length) this.focus = others[Math.floor(Math.random() * others.length)];
    this.nameFront();
    this.update(this.player.time);
  }

  buildNow() {
    this.heading = element("h2", {});
    this.words = element("div", { class: "words", "aria-live": "polite" });
    this.bars = this.data.coordinates.map((axis) => {
      const fill = element("i");
      const value = element("b");
      const row = element(
        "div",
        { class: "bar" },
        element("span", {}, AXES[axis]),
        element("div", {}, fill),
        value,
      );
      return { axis, fill, value, row };
    });
    const note = element("p", { class: "note" }, "Uncertainty, standard deviation (bar: logarithmic)");
    this.now.append(this.heading, this.words, note, ...this.bars.map((bar) => bar.row));
    const moves = this.data.steps.map((_, move) => move);
    new Room(this.words, () => [
      ...moves.map((move) => this.sentences(move, false)),
      this.sentences(moves.length - 1, true),
    ]);
  }

  update(time) {
    if (!this.picture || !this.chart) return;
    const state = stateAt(this.data, time, this.focus);
    this.picture.draw(state, this.options);
    this.chart.show(time);
    this.tell(time, state);
    const count = this.data.steps.length;
    const at = time >= count ? "end" : String(Math.floor(time));
    Object.assign(document.documentElement.dataset, { step: at, spread: JSON.stringify(state.spread) });
  }

  tell(time, state) {
    const count = this.data.steps.length;
    const move = Math.min(Math.floor(time), count - 1);
    const ended = time >= count;
    const key = ended ? "end" : move;
    if (this.told !== key) {
      this.told = key;
      this.heading.textContent = ended
        ? `All ${count} steps are done`
        : `Step ${move}, the last is ${count - 1}`;
      this.words.replaceChildren(...this.sentences(move, ended));
      for (const row of document.querySelectorAll("tr[data-step]")) {
        row.classList.toggle("current", Number(row.dataset.step) === move + 1 && !ended);
      }
    }
    this.showBars(state, move, ended);
  }

  sentences(move, ended) {
    if (ended) {
      const good = this.data.draws.filter((chain) => chain.at_goal).length;
      const particles = termLine(
        "Particles",
        `${this.data.particles.filter((chain) => chain.done).length} of ${this.data.particles.length} done`,
      );
      return this.data.draws.length
        ? [particles, termLine("Random starts", `${good} of ${this.data.draws.length} at the goal`)]
        : [particles];
    }
    const step = this.data.steps[move];
    const lines = [element("p", { class: "move" }, step.words)];
    if (step.outcomes) lines.push(termLine("Particles end by", step.outcomes));
    if (step.touched && step.touched.length) lines.push(termLine("Touches then", step.touched.join(", ")));
    for (const gain of step.gains || []) {
      const verb = gain.settled ? " becomes certain: " : " becomes more certain: ";
      lines.push(element("p", { class: "gain" }, element("b", {}, AXES[gain.axis]), verb, gain.why));
    }
    return lines;
  }

  showBars(state, move, ended) {
    const gains = ended ? [] : this.data.steps[move].gains || [];
    for (const bar of this.bars) {
      bar.row.hidden = !state.spread;
      if (!state.spread) continue;
      const value = state.spread[bar.axis];
      const first = Math.max(...this.data.nodes.map((node) => node.spread[bar.axis]), 1e-9);
      const share = Math.max(0, 1 + Math.log10(Math.max(value, 1e-12) / first) / 3);
      bar.fill.style.width = (100 * share).toFixed(1) + "%";
      bar.value.textContent = smallAmount(value, bar.axis);
      bar.row.classList.toggle(
        "gaining",
        gains.some((gain) => gain.axis === bar.axis),
      );
      bar.row.classList.toggle("certain", value < 0.05 * first);
    }
  }
}
