// What a page's chains look like at a time. Time counts moves: 2.25 is a quarter of the third one.

const AXES = ["x", "y", "z", "rx", "ry", "rz"];

// Paths of whole runs: {class, points}. A picture draws them anew when it is handed another array.
const NO_TRAILS = [];
const TRAIL_CLASSES = ["succeeded", "stopped", "wrong"];

// Ends of lines, pair by pair, about the end of a run: a diamond, a cross or a square, whatever the colours.
function trailMark(name, end, reach) {
  const at = (x, y, z) => [end[0] + reach * x, end[1] + reach * y, end[2] + reach * z];
  const round = (corners) => corners.flatMap((corner, i) => [corner, corners[(i + 1) % corners.length]]);
  if (name === "stopped") {
    const corners = [at(1, 1, 1), at(1, -1, 1), at(1, 1, -1), at(1, -1, -1)];
    return corners.flatMap((corner) => [corner, corner.map((value, i) => 2 * end[i] - value)]);
  }
  const far = name === "wrong" ? 1.2 : 0.6;
  if (name === "wrong") {
    const square = (z) => [at(far, far, z), at(-far, far, z), at(-far, -far, z), at(far, -far, z)];
    const low = square(-far);
    const high = square(far);
    return [...round(low), ...round(high), ...low.flatMap((corner, i) => [corner, high[i]])];
  }
  return [
    ...round([at(far, 0, 0), at(0, far, 0), at(-far, 0, 0), at(0, -far, 0)]),
    ...round([at(far, 0, 0), at(0, 0, far), at(-far, 0, 0), at(0, 0, -far)]),
  ];
}

function shown(value, axis) {
  return axis < 3 ? 1e3 * value : (180 / Math.PI) * value;
}

// With so many digits, and no sign where they are all zero.
function fixed(value, digits) {
  return value.toFixed(digits).replace(/^-(?=[0.]*$)/, "");
}

// What rounds to zero is told without digits, which would promise that they are known.
function amount(value, axis) {
  const number = shown(value, axis);
  const text = fixed(number, Math.abs(number) < 10 ? 2 : 1);
  return (Number(text) === 0 ? "0" : text) + (axis < 3 ? " mm" : "°");
}

// Of what is drawn on a logarithmic scale: two digits that count however small it is.
function smallAmount(value, axis) {
  const number = shown(value, axis);
  if (number >= 0.1) return amount(value, axis);
  const text = number < 1e-4 ? "< 0.0001" : String(Number(number.toPrecision(2)));
  return text + (axis < 3 ? " mm" : "°");
}

// The longest duration of each move over all chains: who is faster rests until the last has ended.
function moveDurations(chains, count) {
  const durations = new Array(count).fill(0);
  for (const chain of chains) {
    chain.durations_s.forEach((value, i) => {
      if (i < count) durations[i] = Math.max(durations[i], value);
    });
  }
  return durations;
}

// Where a chain is, which move it is in, and how long ago, in moves, that move found its end.
function chainAt(chain, time, durations) {
  const moves = chain.poses.length - 1;
  const move = Math.min(Math.floor(time), moves - 1);
  if (moves === 0 || move < 0) return { pose: chain.poses[0], move: -1, age: 0, ended: true };
  const share = durations[move] > 0 ? Math.max(chain.durations_s[move] / durations[move], 0.02) : 1;
  const within = Math.min(time - move, 1);
  const part = Math.min(within / share, 1);
  const pose = between(chain.poses[move], chain.poses[move + 1], part);
  return { pose, move, age: within - share, ended: part >= 1, outcome: chain.outcomes[move] };
}

// What is touched by a chain at that place: contacts count from the end of the move that made them.
function touchedAt(chain, place) {
  if (place.move < 0) return [];
  if (place.ended) return chain.touching[place.move] || [];
  return place.move > 0 ? chain.touching[place.move - 1] : [];
}

function meanOf(points) {
  const sum = [0, 0, 0];
  for (const point of points) point.slice(0, 3).forEach((value, i) => (sum[i] += value));
  return sum.map((value) => value / Math.max(points.length, 1));
}

function spreadAt(nodes, time) {
  if (nodes.length === 0) return null;
  const from = Math.min(Math.floor(time), nodes.length - 1);
  const to = Math.min(from + 1, nodes.length - 1);
  const part = Math.min(time - from, 1);
  return nodes[from].spread.map((value, axis) => value + part * (nodes[to].spread[axis] - value));
}

// All that a scene draws: particles, the chain in the foreground, draws, contacts, the move's arrow.
function stateAt(data, time, focus) {
  const count = data.steps.length;
  data.durations ??= moveDurations([...data.particles, ...data.draws], count);
  const particles = data.particles.map((chain) => chainAt(chain, time, data.durations));
  const front = chainAt(focus, time, data.durations);
  const touched = new Set(touchedAt(focus, front));
  const flashes = [];
  const flash = (place) => {
    const age = place.age;
    if (place.outcome === "contact" && age >= 0 && age < 0.35) {
      flashes.push({ at: place.pose.slice(0, 3), age: age / 0.35 });
    }
  };
  particles.forEach((place, i) => {
    for (const name of touchedAt(data.particles[i], place)) touched.add(name);
    flash(place);
  });
  flash(front);
  const move = Math.min(Math.floor(time), count - 1);
  let arrow = null;
  if (move >= 0 && time < count) {
    const from = meanOf(data.particles.map((chain) => chain.poses[Math.min(move, chain.poses.length - 1)]));
    const step = data.steps[move];
    const along = step.displacement.slice(0, 3);
    arrow = { from, along: step.carried_axes ? carriedAlong(along, front.pose, data.goal) : along };
  }
  return {
    time,
    particles: particles.map((place) => place.pose),
    front: front.pose,
    track: [],
    draws: data.draws.map((chain) => chainAt(chain, time, data.durations).pose),
    mean: meanOf(particles.map((place) => place.pose)),
    spread: spreadAt(data.nodes, time),
    touched,
    flashes,
    arrow,
    trails: NO_TRAILS,
  };
}

// All points that the scene has to show, and the box around them: {points, low, high} in m.
function boundsOf(data) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const points = [];
  const grow = (point) => {
    points.push(point);
    for (let i = 0; i < 3; ++i) {
      low[i] = Math.min(low[i], point[i]);
      high[i] = Math.max(high[i], point[i]);
    }
  };
  const corners = (shape) => {
    const points = [];
    for (let i = 0; i < shape.points_m.length; i += 3) points.push(shape.points_m.slice(i, i + 3));
    return points;
  };
  for (const shape of data.scene.environment) corners(shape).forEach(grow);
  const held = data.scene.held.flatMap(corners);
  const hold = (pose) => held.forEach((corner) => grow(placed(pose, corner)));
  hold(data.goal);
  hold(data.start);
  for (const chain of data.particles) chain.poses.forEach(hold);
  for (const point of data.reached || []) grow(point);
  return { points, low, high };
}
