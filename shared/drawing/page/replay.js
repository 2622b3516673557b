// A recorded run at a time in seconds: where the part was, what it touched, and what the executor felt.

// The last of ascending times that is not after the time.
function momentAt(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= time + 1e-9) low = middle;
    else high = middle - 1;
  }
  return low;
}

// The name of the state that has begun last, of {from_s, name}.
function stateNameAt(states, time) {
  return states.findLast((state) => state.from_s <= time + 1e-9)?.name;
}

class Replay {
  constructor(recording, steps) {
    this.recording = recording;
    this.steps = steps;
    const { times_s, steps: ran } = recording;
    this.end = Math.max(times_s[times_s.length - 1], 1e-3);
    this.stops = [0];
    ran.forEach((step, i) => {
      if (i > 0 && step !== ran[i - 1]) this.stops.push(times_s[i - 1]);
    });
    if (this.stops[this.stops.length - 1] < this.end) this.stops.push(this.end);
  }

  // The moment that has begun last.
  indexAt(time) {
    return momentAt(this.recording.times_s, time);
  }

  poseAt(time) {
    const { times_s, tools } = this.recording;
    const i = this.indexAt(time);
    if (i + 1 >= tools.length) return tools[i];
    return between(tools[i], tools[i + 1], (time - times_s[i]) / (times_s[i + 1] - times_s[i]));
  }

  touchedAt(time) {
    const index = this.indexAt(time);
    const told = this.recording.touching.findLast((entry) => entry.from <= index);
    return told ? told.names : [];
  }

  // All that is ever touched.
  names() {
    return [...new Set(this.recording.touching.flatMap((entry) => entry.names))].sort();
  }

  // From when to when it is, in s.
  spansOf(name) {
    const { touching, times_s } = this.recording;
    return touching.flatMap((entry, i) => {
      const next = touching[i + 1];
      return entry.names.includes(name) ? [[times_s[entry.from], next ? times_s[next.from] : this.end]] : [];
    });
  }

  stepAt(time) {
    return this.recording.steps[this.indexAt(time)];
  }

  // The first moment of a step, or the one of 2.5 halfway to the last; the end for one that never ran.
  timeOf(step) {
    const { steps, times_s } = this.recording;
    const whole = Math.floor(step);
    const first = steps.indexOf(whole);
    if (first < 0) return this.end;
    return times_s[first] + (step - whole) * (times_s[steps.lastIndexOf(whole)] - times_s[first]);
  }

  // What is felt in the moment that ends at or after the time, N or Nm.
  wrenchAt(time, axis) {
    const next = Math.min(this.indexAt(time - 1e-6) + 1, this.recording.times_s.length - 1);
    return this.recording.wrench[axis][next];
  }

  // What a scene draws. trails: paths of other runs.
  stateAt(time, trails) {
    const front = this.poseAt(time);
    const flashes = this.recording.touching
      .filter((entry) => entry.names.length > 0)
      .map((entry) => ({ age: (time - this.recording.times_s[entry.from]) / 0.6, from: entry.from }))
      .filter((flash) => flash.age >= 0 && flash.age < 1)
      .map((flash) => ({ age: flash.age, at: this.recording.tools[flash.from].slice(0, 3) }));
    const track = [...this.recording.tools.slice(0, this.indexAt(time) + 1), front];
    return { ...emptyState(trails), time, front, track, touched: new Set(this.touchedAt(time)), flashes };
  }
}

// Nothing but the paths of runs.
function emptyState(trails) {
  return {
    time: 0,
    particles: [],
    front: null,
    track: [],
    draws: [],
    mean: [0, 0, 0],
    spread: null,
    touched: new Set(),
    flashes: [],
    arrow: null,
    trails,
  };
}
