// An evaluation's page: the ways of all runs, filtered by how they ended, and a few of them replayed.

class EvaluationPage {
  constructor(data) {
    this.data = data;
    this.options = { particles: false, draws: false, paths: true, cut: hidesGoal(data) };
    this.shown = { outcomes: data.outcomes.map(() => true), within: true, beyond: true };
    this.prepare();
    this.player = new Player("run", (time) => this.update(time));
    this.buildStage(document.querySelector("[data-part=stage]"));
    this.buildForces(document.querySelector("[data-part=forces]"));
    for (const button of document.querySelectorAll("button.jump")) {
      button.addEventListener("click", () => {
        this.replay(Number(button.dataset.plan), Number(button.dataset.run));
        this.stage.comeIntoView();
        this.player.play();
      });
    }
    this.begin();
  }

  // What the scene needs beside the data of the page itself.
  prepare() {
    const { data } = this;
    Object.assign(data, { particles: [], draws: [], reached: [], start: data.plans[0].start });
    for (const plan of data.plans) {
      for (const run of plan.runs) {
        run.class = data.outcomes[run.outcome].class;
        run.points = [];
        for (let i = 0; i < run.path.length; i += 3) run.points.push(run.path.slice(i, i + 3));
        data.reached.push(...run.points);
      }
    }
  }

  begin() {
    const asked = /run=(\d+)/.exec(location.hash);
    const plan = Number((/plan=(\d+)/.exec(location.hash) || [0, 0])[1]);
    const own = this.data.plans[plan] ? plan : 0;
    const { recordings } = this.data.plans[own];
    const failed = recordings.find((entry) => this.data.outcomes[entry.outcome].class !== "succeeded");
    const first = asked ? Number(asked[1]) : (failed || recordings[0])?.run;
    this.replay(own, first);
    const step = /step=([\d.]+)/.exec(location.hash);
    const time = step ? this.current?.timeOf(Number(step[1])) : this.current?.end;
    this.player.jump(time ?? 0);
    document.documentElement.dataset.ready = "true";
  }

  buildStage(host) {
    const box = (name, colour, text) =>
      optionBox(this.options, name, colour, text, () => this.update(this.player.time));
    this.frontText = element("span");
    const legend = element(
      "div",
      { class: "legend" },
      keyOf("part", this.frontText),
      box("paths", "muted", "paths of runs"),
      keyOf("goal", "goal"),
      keyOf("contact", "touched"),
      cutBox(this.options, () => this.update(this.player.time)),
    );
    this.filters = element("div", { class: "filters", role: "group", "aria-label": "Runs that are shown" });
    this.stage = new Stage(host, this.data, [this.filters, this.player.controls], legend);
    this.buildFilters();
    this.buildNow();
  }

  buildFilters() {
    const { data, shown } = this;
    if (data.plans.length > 1) {
      this.choice = element("select", { "aria-label": "Plan" });
      data.plans.forEach((plan, i) => this.choice.append(element("option", { value: i }, plan.name)));
      this.choice.addEventListener("change", () => {
        const own = Number(this.choice.value);
        this.replay(own, this.data.plans[own].recordings[0]?.run);
      });
      this.filters.append(this.choice);
    }
    const filter = (values, key, sign, text) => {
      const button = element("button", { type: "button", class: "filter", "aria-pressed": true });
      const count = element("b");
      button.append(markOf(sign), element("span", {}, text), count);
      button.addEventListener("click", () => {
        values[key] = !values[key];
        button.setAttribute("aria-pressed", values[key]);
        this.filter();
      });
      this.filters.append(button);
      return { button, count };
    };
    this.outcomeFilters = data.outcomes.map((outcome, i) =>
      filter(shown.outcomes, i, outcome.class, outcome.name),
    );
    this.withinFilter = filter(shown, "within", null, "within " + data.reach);
    this.beyondFilter = filter(shown, "beyond", null, "beyond");
    this.shownText = element("span", { class: "note", "aria-live": "polite" });
    this.filters.append(this.shownText);
  }

  buildNow() {
    this.heading = element("h2", {});
    this.words = element("div", { class: "words", "aria-live": "polite" });
    this.state = element("div", { class: "words" });
    this.others = element("div", { class: "others" });
    this.stage.now.append(this.heading, this.words, this.state, this.others);
    this.rooms = [
      new Room(this.words, () => {
        if (!this.current) return [];
        const { recording } = this.current;
        const ran = [...new Set(recording.steps)];
        return [...ran.map((step) => this.stepWords(step)), this.ending(recording)];
      }),
      new Room(this.state, () =>
        (this.current?.recording.touching || []).map(({ names }) => this.stateWords(0, names)),
      ),
    ];
  }

  buildForces(host) {
    this.forces = host;
    this.chart = new ForceChart(host, (time) => this.player.jump(time));
    host.append(
      element(
        "p",
        { class: "note" },
        "External force at the tool along the task's axes, the largest of each moment; dashed: a contact begins, ",
        "dotted: it ends. Vertical lines: one step ends and the next begins. A click leads there.",
      ),
    );
  }

  // Shows a plan, and a run of it that was recorded.
  replay(planIndex, number) {
    this.plan = this.data.plans[planIndex];
    if (this.choice) this.choice.value = planIndex;
    const recording = this.plan.recordings.find((entry) => entry.run === number);
    this.current = recording ? new Replay(recording, this.plan.steps) : null;
    this.player.pause();
    this.player.controls.hidden = this.forces.hidden = !this.current;
    this.frontText.textContent = this.current
      ? "the part in run " + number
      : "the part (nothing was recorded)";
    this.told = null;
    if (this.current) {
      const axes = [0, 1, 2].concat(this.data.coordinates.filter((axis) => axis > 2));
      this.player.setSpan({
        stops: this.current.stops,
        perSecond: 1,
        nameOf: (time) =>
          time >= this.current.end ? "end" : `${time.toFixed(1)} s, step ${this.current.stepAt(time)}`,
      });
      this.chart.setReplay(this.current, axes, "Run " + number);
      this.rooms.forEach((room) => room.measure());
    }
    document.documentElement.dataset.run = this.current ? number : "";
    this.listOthers();
    this.countFilters();
    this.filter();
    this.player.jump(0);
  }

  listOthers() {
    const buttons = this.plan.recordings.map((entry) => {
      const outcome = this.data.outcomes[entry.outcome];
      const button = element("button", { type: "button", class: "filter", title: "Replay: " + outcome.name });
      button.append(markOf(outcome.class), "run " + entry.run);
      button.setAttribute("aria-pressed", entry === this.current?.recording);
      button.addEventListener("click", () => {
        this.replay(this.data.plans.indexOf(this.plan), entry.run);
        this.player.play();
      });
      return button;
    });
    this.others.replaceChildren(
      element(
        "p",
        { class: "note" },
        buttons.length ? "Runs to replay" : "No run to replay: none began its plan",
      ),
      ...buttons,
    );
  }

  countFilters() {
    const { counts, beyond, count } = this.plan;
    this.outcomeFilters.forEach((filter, i) => {
      filter.count.textContent = counts[i];
      filter.button.hidden = counts[i] === 0;
    });
    this.withinFilter.count.textContent = count - beyond;
    this.beyondFilter.count.textContent = beyond;
    this.withinFilter.button.hidden = this.beyondFilter.button.hidden = beyond === 0;
  }

  filter() {
    const { outcomes, within, beyond } = this.shown;
    this.trails = this.plan.runs.filter((run) => outcomes[run.outcome] && (run.beyond ? beyond : within));
    const all = this.plan.runs.length;
    const some = all < this.plan.count ? ` (of ${this.plan.count})` : "";
    this.shownText.textContent = `${this.trails.length} of ${all} paths shown${some}`;
    document.documentElement.dataset.shown = this.trails.length;
    this.update(this.player.time);
  }

  update(time) {
    if (!this.trails || !this.chart) return;
    const state = this.current ? this.current.stateAt(time, this.trails) : emptyState(this.trails);
    this.stage.picture.draw(state, this.options);
    if (!this.current) {
      this.heading.textContent = this.plan.name;
      return;
    }
    this.chart.show(time);
    const ended = time >= this.current.end;
    const step = this.current.stepAt(time);
    this.tell(time, ended, step);
    Object.assign(document.documentElement.dataset, {
      step: ended ? "end" : String(step),
      tool: JSON.stringify(state.front),
    });
  }

  tell(time, ended, step) {
    const entry = this.current.recording;
    const outcome = this.data.outcomes[entry.outcome];
    const key = ended ? "end" : step;
    if (this.told !== key) {
      this.told = key;
      this.heading.textContent = `Run ${entry.run}, ${ended ? outcome.name : "step " + step}`;
      this.words.replaceChildren(...(ended ? this.ending(entry) : this.stepWords(step)));
    }
    this.state.replaceChildren(...this.stateWords(time, this.current.touchedAt(time)));
  }

  stateWords(time, names) {
    const felt = [0, 1, 2].map((axis) => fixed(this.current.wrenchAt(time, axis), 1));
    return [
      termLine("Time", `${time.toFixed(2)} of ${this.current.end.toFixed(2)} s`),
      termLine("Touches", names.length ? names.join(", ") : "nothing"),
      termLine("Feels", `x ${felt[0]}, y ${felt[1]}, z ${felt[2]} N`),
    ];
  }

  stepWords(step) {
    const { words, force_on_N } = this.plan.steps[step] || { words: "" };
    return [
      element("p", { class: "move" }, words),
      termLine("Contact from", force_on_N === undefined ? "" : `${force_on_N.toFixed(1)} N`),
    ];
  }

  ending(entry) {
    const lines = [element("p", { class: "move" }, entry.reason)];
    lines[0].classList.toggle("long", entry.reason.length > 60);
    lines.push(termLine("Start", entry.out));
    if (entry.error_m !== undefined) {
      const tolerance = amount(this.data.goal_tolerance_m, 0);
      lines.push(termLine("From the goal", `${amount(entry.error_m, 0)} (${tolerance} allowed)`));
    }
    if (entry.step >= 0)
      lines.push(termLine("Last step", `${entry.step}, ${entry.step_outcome || "cut short"}`));
    lines.push(termLine("Largest force", `${entry.contact_force_N_max} N`));
    return lines;
  }
}

// The sign of an outcome as the scene marks it; nothing for none.
function markOf(name) {
  if (!name) return "";
  const paths = {
    succeeded: "M7 1l6 6l-6 6l-6 -6z",
    stopped: "M2 2l10 10M12 2l-10 10",
    wrong: "M2 2h10v10h-10z",
  };
  const icon = svgElement("svg", {
    viewBox: "0 0 14 14",
    width: 13,
    height: 13,
    "aria-hidden": "true",
    class: "mark " + name,
  });
  icon.append(svgElement("path", { d: paths[name] }));
  return icon;
}
