// A run laid over its plan: its way in the scene, what it felt over time, and what happens now.

// "-x +z" of contact bits.
function contactsOf(bits) {
  const names = AXES.flatMap((axis) => ["+" + axis, "-" + axis]);
  return names.filter((_, i) => (bits >> i) & 1).join(" ") || "nothing";
}

class RunPage {
  constructor(data) {
    this.data = data;
    this.run = data.run;
    this.options = { particles: false, draws: false, paths: true, fit: data.run.fit !== null };
    this.options.cut = hidesGoal(data);
    this.prepare();
    this.player = new Player("run", (time) => this.update(time));
    this.player.setSpan({ stops: this.stops(), perSecond: 1, nameOf: (time) => this.nameOf(time) });
    this.buildStage(document.querySelector("[data-part=stage]"));
    const jump = (time) => this.player.jump(time);
    const curves = document.querySelector("[data-part=curves]");
    this.curves = curves && this.run.curves ? new RunCurves(curves, data, jump) : null;
    const chart = document.querySelector("[data-part=uncertainty]");
    this.chart = chart && new UncertaintyChart(chart, data, (step) => jump(this.endOf(step - 1)));
    this.listen();
    this.begin();
  }

  // A replay out of the curves, or out of the places where the steps came to rest.
  prepare() {
    const { run, data } = this;
    const curves = run.curves || {
      times_s: [0, ...run.spans.map((span) => Math.max(span.to_s, 1e-3))],
      tools: [data.start, ...run.spans.map((span) => span.tool || null)],
    };
    const known = curves.tools.find((tool) => tool !== null) || data.start;
    let last = known;
    const tools = curves.tools.map((tool) => (last = tool || last));
    const plain = { times_s: curves.times_s, tools, steps: [], touching: [] };
    this.replays = { plain: new Replay(plain, data.steps) };
    if (run.fit) {
      const fitted = { ...plain, tools: tools.map((tool) => composed(run.fit, tool)) };
      this.replays.fit = new Replay(fitted, data.steps);
    }
    data.reached = [...tools, ...(this.replays.fit?.recording.tools || [])].map((tool) => tool.slice(0, 3));
    this.end = this.replays.plain.end;
  }

  get replay() {
    return this.options.fit ? this.replays.fit : this.replays.plain;
  }

  stops() {
    const times = [0, ...this.run.spans.flatMap((span) => [span.from_s, span.to_s]), this.end];
    const rounded = [...new Set(times.map((time) => Math.min(time, this.end)))].sort((a, b) => a - b);
    return rounded.filter((time, i) => i === 0 || time - rounded[i - 1] > 0.02 || time === this.end);
  }

  // The step that runs, or the last that has begun; none before the first.
  spanAt(time) {
    return this.run.spans.findLast((span) => span.from_s <= time + 1e-9);
  }

  nameOf(time) {
    const span = this.spanAt(time);
    if (time >= this.end) return "end";
    return `${time.toFixed(1)} s, ${span ? "step " + span.step : stateNameAt(this.run.states, time) || "begins"}`;
  }

  // When a step of the plan was over, or the run was.
  endOf(step) {
    if (step < 0) return 0;
    return this.run.spans.find((span) => span.step === step)?.to_s ?? this.end;
  }

  // When the run was at a place in moves of the plan; its end where it never came there.
  timeOf(planTime) {
    const span = this.run.spans.find((one) => one.step === Math.floor(planTime));
    return span ? span.from_s + (planTime % 1) * (span.to_s - span.from_s) : this.end;
  }

  // In moves of the plan.
  planTimeAt(time) {
    const span = this.spanAt(time);
    if (!span) return 0;
    const length = Math.max(span.to_s - span.from_s, 1e-6);
    return span.step + Math.min((time - span.from_s) / length, 1);
  }

  listen() {
    const lead = (button, time) =>
      button.addEventListener("click", () => {
        this.player.jump(time());
        this.stage.comeIntoView();
      });
    for (const button of document.querySelectorAll("button.jump")) {
      const { time, span, step } = button.dataset;
      if (time !== undefined) lead(button, () => Number(time));
      else if (span !== undefined) lead(button, () => this.run.spans[Number(span)].from_s);
      else lead(button, () => this.endOf(Number(step) - 1));
    }
  }

  begin() {
    const asked = (name) => new RegExp(`[#&]${name}=(\\d+(\\.\\d+)?)`).exec(location.hash)?.[1];
    const [time, step] = [asked("time"), asked("step")];
    this.player.jump(Number(time ?? (step ? this.timeOf(Number(step)) : this.end)));
    document.documentElement.dataset.ready = "true";
  }

  buildStage(host) {
    const box = (name, colour, text) =>
      optionBox(this.options, name, colour, text, () => this.update(this.player.time));
    const count = this.data.particles.length;
    const legend = element(
      "div",
      { class: "legend" },
      keyOf("part", "as measured"),
      keyOf("ink", "measured path"),
      count ? box("paths", "particle", `planned paths (${count})`) : null,
      count ? box("particles", "particle", "particles") : null,
      count ? keyOf("goal", "goal") : null,
      this.run.fit ? box("fit", "ink", "moved onto the goal") : null,
      count ? cutBox(this.options, () => this.update(this.player.time)) : null,
    );
    this.stage = new Stage(host, this.data, [this.player.controls], legend);
    this.heading = element("h2", {});
    this.words = element("div", { class: "words", "aria-live": "polite" });
    this.state = element("div", { class: "words" });
    this.stage.now.append(this.heading, this.words, this.state);
    new Room(this.words, () => [
      ...this.run.spans.flatMap((span) => [this.stepWords(span, false), this.stepWords(span, true)]),
      this.ending(),
    ]);
    const times = [...this.stops(), ...this.run.states.map((state) => state.from_s)];
    new Room(this.state, () =>
      times.map((time) => this.sensed(time, stateNameAt(this.run.states, time) || "")),
    );
    if (this.run.fit) this.stage.now.append(this.fitNote());
  }

  // What the shift says: the environment was not where the task has it.
  fitNote() {
    const way = this.run.fit.slice(0, 3).map((value) => fixed(-1e3 * value, 1));
    const text =
      this.run.fit[3] > 1 - 1e-9
        ? `The run ended ${way.join(", ")} mm (x, y, z) from the drawn goal: so far was the environment from ` +
          "where the task has it, if the part arrived. Its path is drawn moved by that."
        : "The environment was not where the task has it. The path is drawn moved so that it ends at the goal.";
    return element("p", { class: "note" }, text);
  }

  update(time) {
    if (!this.stage || this.chart === undefined) return;
    const planTime = this.planTimeAt(time);
    const front = this.replay.poseAt(time);
    const track = [...this.replay.recording.tools.slice(0, this.replay.indexAt(time) + 1), front];
    const { particles } = this.data;
    const planned = particles.length ? stateAt(this.data, planTime, particles[0]) : emptyState(NO_TRAILS);
    const arrow = planned.arrow && { ...planned.arrow, from: front.slice(0, 3) };
    const state = { ...planned, front, track, arrow, touched: new Set(), flashes: this.flashesAt(time) };
    this.stage.picture.draw(state, this.options);
    if (this.curves) this.curves.show(time);
    if (this.chart) this.chart.show(planTime);
    this.tell(time);
    const span = this.spanAt(time);
    Object.assign(document.documentElement.dataset, {
      step: time >= this.end ? "end" : span ? String(span.step) : "none",
      tool: JSON.stringify(front),
      time: time.toFixed(3),
    });
  }

  flashesAt(time) {
    return this.run.spans
      .filter((span) => span.outcome === "contact")
      .map((span) => ({ age: (time - span.to_s) / 0.6, at: this.replay.poseAt(span.to_s).slice(0, 3) }))
      .filter((flash) => flash.age >= 0 && flash.age < 1);
  }

  tell(time) {
    const ended = time >= this.end;
    const span = this.spanAt(time);
    const over = span && time > span.to_s;
    const key = ended ? "end" : span ? this.run.spans.indexOf(span) + (over ? 0.5 : 0) : "none";
    if (this.told !== key) {
      this.told = key;
      this.words.replaceChildren(...(ended ? this.ending() : this.stepWords(span, over)));
      for (const row of document.querySelectorAll("tr[data-span], tr[data-step]")) {
        const own =
          row.dataset.span === undefined
            ? Number(row.dataset.step) - 1 === span?.step
            : this.run.spans[Number(row.dataset.span)] === span;
        row.classList.toggle("current", own && !ended);
      }
    }
    const state = stateNameAt(this.run.states, time) || "";
    this.heading.textContent = ended
      ? this.endTitle()
      : span
        ? `Step ${span.step}`
        : state || "Before the plan";
    this.state.replaceChildren(...this.sensed(time, state));
  }

  endTitle() {
    if (!this.run.ended) return "The log ends here";
    return this.run.done ? "Done" : "Not done";
  }

  ending() {
    const { message, spans } = this.run;
    const lines = message ? [element("p", { class: "move" }, message)] : [];
    if (message.length > 60) lines[0].classList.add("long");
    const finished = spans.filter((span) => span.outcome).length;
    lines.push(termLine("Steps", `${finished} of ${this.data.steps.length} in the plan`));
    return lines;
  }

  stepWords(span, over) {
    if (!span) return [];
    const lines = [element("p", { class: "move" }, this.data.steps[span.step].words)];
    lines.push(termLine(over ? "Ended by" : "Ends by", span.outcome || "nothing: it was cut short"));
    if (span.outcome) lines.push(termLine("Contacts then", span.signature));
    if (span.peak_force_N !== undefined)
      lines.push(termLine("Largest force", `${span.peak_force_N.toFixed(1)} N`));
    if (span.deviation) lines.push(element("p", { class: "gain bad" }, span.deviation));
    return lines;
  }

  sensed(time, state) {
    const lines = [termLine("Time", `${time.toFixed(2)} of ${this.end.toFixed(2)} s`)];
    if (state) lines.push(termLine("Executor", state));
    const { curves } = this.run;
    if (!curves) return lines;
    const index = momentAt(curves.times_s, time);
    if (this.spanAt(time)) lines.push(termLine("Holds", contactsOf(curves.signatures[index])));
    const felt = [0, 1, 2].map((axis) => curves.wrench[axis][index]);
    if (felt.every((value) => value !== null)) {
      lines.push(
        termLine(
          "Feels",
          AXES.slice(0, 3)
            .map((axis, i) => `${axis} ${fixed(felt[i], 1)}`)
            .join(", ") + " N",
        ),
      );
    }
    return lines;
  }
}
