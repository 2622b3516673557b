// Poses are arrays [x, y, z, qw, qx, qy, qz] in m, vectors [x, y, z].

function rotated(pose, v) {
  const [w, x, y, z] = pose.slice(3);
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1],
    v[1] + w * t[1] + z * t[0] - x * t[2],
    v[2] + w * t[2] + x * t[1] - y * t[0],
  ];
}

function placed(pose, v) {
  const r = rotated(pose, v);
  return [pose[0] + r[0], pose[1] + r[1], pose[2] + r[2]];
}

// A pose that stands in another one.
function composed(a, b) {
  const [w, x, y, z] = a.slice(3);
  const [bw, bx, by, bz] = b.slice(3);
  return [
    ...placed(a, b),
    w * bw - x * bx - y * by - z * bz,
    w * bx + x * bw + y * bz - z * by,
    w * by - x * bz + y * bw + z * bx,
    w * bz + x * by - y * bx + z * bw,
  ];
}

// Straight in position, and at constant speed about one axis in orientation.
function between(a, b, part) {
  if (part <= 0) return a;
  if (part >= 1) return b;
  const pose = a.slice(0, 3).map((value, i) => value + part * (b[i] - value));
  const qa = a.slice(3);
  let qb = b.slice(3);
  let dot = qa.reduce((sum, value, i) => sum + value * qb[i], 0);
  if (dot < 0) {
    dot = -dot;
    qb = qb.map((value) => -value);
  }
  let weightA = 1 - part;
  let weightB = part;
  if (dot < 0.9999) {
    const angle = Math.acos(dot);
    weightA = Math.sin((1 - part) * angle) / Math.sin(angle);
    weightB = Math.sin(part * angle) / Math.sin(angle);
  }
  const q = qa.map((value, i) => weightA * value + weightB * qb[i]);
  const norm = Math.hypot(...q);
  return pose.concat(q.map((value) => value / norm));
}

// The displacement in the task frame's axes of a step whose axes turn with the tool.
function carriedAlong(displacement, tool, goal) {
  const inverse = [0, 0, 0, goal[3], -goal[4], -goal[5], -goal[6]];
  return rotated(tool, rotated(inverse, displacement));
}
