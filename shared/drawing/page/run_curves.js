// Which curves a run's page shows, and what is drawn beside them.

const AXIS_COLOURS = ["curve-a", "curve-b", "curve-c"];

function largest(values) {
  return values.reduce((most, value) => (value === null ? most : Math.max(most, Math.abs(value))), 0);
}

// Between the least and the largest value that is known.
function extent(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value === null) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return high < low ? 0 : high - low;
}

function times(factor, values) {
  return values.map((value) => (value === null ? null : factor * value));
}

class RunCurves {
  constructor(host, data, jump) {
    this.data = data;
    this.run = data.run;
    this.curves = data.run.curves;
    const timed = this.run.faults.filter((fault) => fault.time_s !== undefined);
    const end = this.curves.times_s[this.curves.times_s.length - 1];
    this.plots = new RunPlots(host, {
      spans: this.run.spans,
      faults: timed,
      end,
      jump,
      why: (time) => this.why(time),
    });
    this.addWrench(0);
    this.addWrench(3);
    this.addMotion([0, 1, 2], "Tool's place in the task frame", "mm", 1e3, 1e-4);
    this.addMotion([3, 4, 5], "Tool's rotation since the plan's start", "°", 180 / Math.PI, 1e-3);
    this.addJoint(0);
    this.addTiming();
    this.addBus();
  }

  show(time) {
    this.plots.show(time);
  }

  // What the executor did where nothing is commanded, or measured.
  why(time) {
    const name = stateNameAt(this.run.states, time);
    if (!name) return "";
    return name === "finished" ? "the run had ended" : `the executor was ${name}`;
  }

  // Force or torque: its axes, its length, and what the plan and the cell say of it.
  addWrench(first) {
    const force = first === 0;
    const unit = force ? "N" : "Nm";
    const { wrench, times_s } = this.curves;
    const { limits } = this.run;
    const limit = force ? limits.force_limit_N : limits.torque_limit_Nm;
    const fault = force ? limits.force_fault_N : limits.torque_fault_Nm;
    const most = largest(wrench[force ? 6 : 7]);
    const names = force ? ["force_on_N", "force_off_N"] : ["torque_on_Nm", "torque_off_Nm"];
    const on = Math.max(...this.run.spans.map((span) => this.data.steps[span.step][names[0]]), 0);
    const series = [0, 1, 2].map((i) => ({
      name: AXES[first + i],
      values: wrench[first + i],
      colour: AXIS_COLOURS[i],
    }));
    series.push({ name: "in all", values: wrench[force ? 6 : 7], colour: "ink", width: 1, hidden: true });
    const title = force ? "Force on the tool" : "Torque on the tool";
    const digits = force ? 1 : 2;
    this.plots.add({
      title,
      unit,
      digits,
      height: 240,
      series,
      times: times_s,
      range: (_, low, high) => {
        const seen = Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0), 1.2 * on);
        // A limit that is far off would make everything small.
        const near = [limit, fault].filter((value) => value && seen > 0.6 * value);
        const end = 1.08 * Math.max(seen, ...near);
        return [-end, end];
      },
      draw: (chart, context, ratio) => {
        this.drawThresholds(chart, context, ratio, names);
        for (const value of [limit, -limit]) {
          horizontal(chart, context, ratio, { value, colour: "ink", dash: [], width: 1 });
        }
        if (!fault) return;
        for (const value of [fault, -fault]) {
          horizontal(chart, context, ratio, { value, colour: "bad", dash: [], width: 2 });
        }
      },
      note:
        `Dashed: a contact begins; dotted: it ends. Largest: ${most.toFixed(digits)} ${unit}. ` +
        `The plan holds the tool back at ${limit} ${unit} (thin line)` +
        (fault ? `; the cell ends the run at ${fault} ${unit} (thick line).` : "."),
      label: `${title} over time, ${[0, 1, 2]
        .map((i) => `${AXES[first + i]} at most ${largest(wrench[first + i]).toFixed(digits)} ${unit}`)
        .join(", ")}, in all at most ${most.toFixed(digits)} ${unit}`,
    });
  }

  drawThresholds(chart, context, ratio, [on, off]) {
    for (const span of this.run.spans) {
      const step = this.data.steps[span.step];
      for (const sign of [1, -1]) {
        const line = (value, dash) =>
          horizontal(chart, context, ratio, {
            value: sign * value,
            from: span.from_s,
            to: span.to_s,
            colour: "muted",
            dash,
            width: 1.4,
          });
        line(step[on], [6, 4]);
        line(step[off], [1.5, 4]);
      }
    }
  }

  // Axes that move, as measured and as commanded.
  addMotion(axes, title, unit, factor, least) {
    const { measured, commanded, times_s } = this.curves;
    const moving = axes.filter((axis) => extent(measured[axis]) > least);
    if (moving.length === 0) return;
    const series = moving.flatMap((axis) => {
      const colour = AXIS_COLOURS[axis % 3];
      return [
        { name: AXES[axis], values: times(factor, measured[axis]), colour, width: 2 },
        {
          name: "",
          with: AXES[axis],
          values: times(factor, commanded[axis]),
          colour: "ink",
          dash: [3, 3],
          width: 1,
          missing: "not commanded",
        },
      ];
    });
    this.plots.add({
      title,
      unit,
      digits: 2,
      height: 220,
      series,
      times: times_s,
      note: "Coloured: measured; dotted: commanded, while the plan runs.",
      label: `${title} over time, measured and commanded, along ${moving.map((axis) => AXES[axis]).join(", ")}`,
    });
  }

  // One joint, chosen above it: where it is, and how far from where it should be.
  addJoint(index) {
    const { joints } = this.curves;
    if (joints.length === 0) return;
    this.jointPlots = [
      this.plots.add(this.jointPlace(joints[index])),
      this.plots.add(this.jointError(joints[index])),
    ];
    this.offerJoints(index);
  }

  offerJoints(index) {
    const select = element("select", { "aria-label": "Joint that is shown" });
    this.curves.joints.forEach((joint, i) => select.append(element("option", { value: i }, joint.name)));
    select.value = index;
    select.addEventListener("change", () => {
      this.showJoint(Number(select.value));
      this.select.focus();
    });
    this.select = select;
    this.jointPlots[0].heading.append(" ", select);
  }

  showJoint(index) {
    const joint = this.curves.joints[index];
    this.jointPlots = [
      this.plots.replace(this.jointPlots[0], this.jointPlace(joint)),
      this.plots.replace(this.jointPlots[1], this.jointError(joint)),
    ];
    this.offerJoints(index);
    this.plots.show(this.plots.time);
  }

  jointPlace(joint) {
    const factor = joint.linear ? 1e3 : 180 / Math.PI;
    const unit = joint.linear ? "mm" : "°";
    const limits = [joint.lower, joint.upper].map((value) => (factor * value).toFixed(joint.linear ? 0 : 1));
    return {
      title: "Joint",
      unit,
      digits: 2,
      height: 180,
      times: this.curves.times_s,
      series: [
        { name: "measured", values: times(factor, joint.measured), colour: "curve-a", width: 2 },
        {
          name: "commanded",
          values: times(factor, joint.commanded),
          colour: "ink",
          dash: [3, 3],
          width: 1,
          missing: "not commanded",
        },
      ],
      draw: (chart, context, ratio) => {
        for (const value of [joint.lower, joint.upper]) {
          horizontal(chart, context, ratio, { value: factor * value, colour: "bad", dash: [], width: 2 });
        }
      },
      note: `It may be between ${limits[0]} and ${limits[1]} ${unit}. It is commanded while the plan runs.`,
      label: `Joint ${joint.name} over time, measured and commanded`,
    };
  }

  jointError(joint) {
    const factor = joint.linear ? 1e3 : 180 / Math.PI;
    const unit = joint.linear ? "mm" : "°";
    const most = (factor * largest(joint.off)).toFixed(3);
    return {
      title: "Its distance from the command",
      unit,
      digits: 3,
      height: 140,
      times: this.curves.times_s,
      series: [
        {
          name: "measured less commanded",
          values: times(factor, joint.off),
          colour: "curve-b",
          missing: "not commanded",
        },
      ],
      label: `Joint ${joint.name}: measured less commanded over time, at most ${most} ${unit}`,
    };
  }

  addTiming() {
    const { times_s, wakeup_late_us, compute_us, late_cycles } = this.curves;
    const period_us = this.run.limits.cycle_s ? 1e6 * this.run.limits.cycle_s : null;
    const shown = (values) => values.map((value) => (value === null ? null : Math.max(value, 1)));
    const late = late_cycles.reduce((sum, count) => sum + count, 0);
    if (!largest(wakeup_late_us) && !largest(compute_us) && !late) return;
    this.plots.add({
      title: "Cycle's timing",
      unit: "µs",
      digits: 0,
      height: 200,
      times: times_s,
      scale: { distr: 3 },
      range: (_, low, high) => [
        10 ** Math.floor(Math.log10(low ?? 1)),
        1.5 * Math.max(high ?? 10, period_us ?? 10),
      ],
      series: [
        { name: "awake after the due time", values: shown(wakeup_late_us), colour: "curve-a" },
        { name: "computing", values: shown(compute_us), colour: "curve-b" },
      ],
      draw: (chart, context, ratio) => this.drawLate(chart, context, ratio, period_us),
      note:
        (period_us ? `Thick line: the period, ${period_us} µs. ` : "") +
        (late ? `Late cycles: ${late}, red marks at the foot.` : "No cycle was late."),
      label:
        `Timing over time: awake at most ${largest(wakeup_late_us).toFixed(0)} µs after the due time, ` +
        `computing at most ${largest(compute_us).toFixed(0)} µs, ${late} late cycles`,
    });
  }

  drawLate(chart, context, ratio, period_us) {
    if (period_us) horizontal(chart, context, ratio, { value: period_us, colour: "bad", dash: [], width: 2 });
    const { times_s, late_cycles } = this.curves;
    const { top, height } = chart.bbox;
    context.fillStyle = colourOf("bad");
    late_cycles.forEach((count, i) => {
      if (count === 0) return;
      context.fillRect(
        chart.valToPos(times_s[i], "x", true) - ratio,
        top + height - 12 * ratio,
        2 * ratio,
        12 * ratio,
      );
    });
  }

  addBus() {
    const { bus, limits } = this.run;
    if (!bus || bus.times_s.length < 2) return;
    const most = limits.bus_load_most ? 100 * limits.bus_load_most : null;
    const worst = 100 * largest(bus.load_worst);
    this.plots.add({
      title: "Load of the bus",
      unit: "%",
      digits: 1,
      height: 160,
      times: bus.times_s,
      range: (_, low, high) => [0, 1.1 * Math.max(high ?? 0, most ?? 0, 1)],
      series: [
        { name: "frames alone", values: times(100, bus.load), colour: "curve-a" },
        { name: "with all stuff bits that can be", values: times(100, bus.load_worst), colour: "curve-b" },
      ],
      draw: (chart, context, ratio) => {
        if (most) horizontal(chart, context, ratio, { value: most, colour: "bad", dash: [], width: 2 });
      },
      note: most ? `Thick line: what its frames may take, ${most.toFixed(0)} %.` : undefined,
      label: `Load of the bus over time, at most ${worst.toFixed(1)} %`,
    });
  }
}
