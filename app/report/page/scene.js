// Particles of a run's snapshots as a film: WebGL 2, or a plain canvas where there is none.

/** A reader of the keys of the deck, which are written as in TOML. */
function keysOf(deck) {
  const value = key => {
    try { return JSON.parse(deck[key]); } catch { return deck[key]; }
  };
  const numbers = prefix => [...new Set(Object.keys(deck).filter(k => k.startsWith(prefix + '.')).map(k => k.split('.')[1]))];
  return {value, numbers};
}

/** Ends of lines [x y z, x y z, ...] around the part of a plane that lies in a box. */
function planeInBox(point, normal, lo, hi, dim) {
  const corners = [];
  const side = p => normal.reduce((sum, n, c) => sum + n * (p[c] - point[c]), 0);
  const corner = bits => [0, 1, 2].map(c => c < dim ? (bits >> c & 1 ? hi[c] : lo[c]) : 0);
  for (let bits = 0; bits < 1 << dim; ++bits) {
    for (let c = 0; c < dim; ++c) {
      if (bits >> c & 1) continue;
      const a = corner(bits), b = corner(bits | 1 << c), da = side(a), db = side(b);
      if (da * db > 0 || da === db) continue;
      const t = da / (da - db);
      corners.push(a.map((x, k) => x + t * (b[k] - x)));
    }
  }
  return corners;
}

function outline(corners, normal) {
  if (corners.length < 2) return [];
  if (corners.length === 2 || normal.length === 2) return [...corners[0], ...corners[corners.length - 1]];
  const middle = [0, 1, 2].map(c => corners.reduce((s, p) => s + p[c], 0) / corners.length);
  const across = Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const u = cross(normal, across), v = cross(normal, u);
  const angle = p => Math.atan2(...[v, u].map(e => e.reduce((s, x, c) => s + x * (p[c] - middle[c]), 0)));
  const sorted = [...corners].sort((a, b) => angle(a) - angle(b));
  return sorted.flatMap((p, i) => [...p, ...sorted[(i + 1) % sorted.length]]);
}

/** A rectangle around a point: width along the axis that is least aligned with the normal, as the deck says. */
function plateOutline(point, normal, width, depth, dim) {
  const length = Math.hypot(...normal), n = normal.map(x => x / length);
  if (dim === 2) return [point[0] + n[1] * width / 2, point[1] - n[0] * width / 2, 0, point[0] - n[1] * width / 2, point[1] + n[0] * width / 2, 0];
  const least = n.map(Math.abs).indexOf(Math.min(...n.map(Math.abs)));
  let u = n.map((x, c) => (c === least ? 1 : 0) - x * n[least]);
  u = u.map(x => x / Math.hypot(...u));
  const v = [n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]];
  const at = (a, b) => point.map((x, c) => x + a * u[c] * width / 2 + b * v[c] * depth / 2);
  const ring = [at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)];
  return ring.flatMap((p, i) => [...p, ...ring[(i + 1) % 4]]);
}

/** Walls of the deck as lines, moving ones where the series says that they were. */
function wallLines(view, time) {
  const deck = keysOf(data.deck || {}), dim = view.dimension, lines = [];
  const lo = deck.value('domain.lo') || view.lo, hi = deck.value('domain.hi') || view.hi;
  for (const i of deck.numbers('wall')) {
    const of = key => deck.value(`wall.${i}.${key}`), normal = of('normal'), given = of('point');
    if (!Array.isArray(normal) || !Array.isArray(given)) continue;
    const point = [0, 1, 2].map(c => c < dim ? wallAt(String(of('name')), c, time) ?? given[c] : 0);
    lines.push(...(of('kind') === 'plate' ? plateOutline(point, normal, of('width'), of('depth'), dim)
      : outline(planeInBox(point, normal, lo, hi, dim), normal)));
  }
  return lines;
}

function wallAt(name, axis, time) {
  if (!data.series) return null;
  const column = data.series.columns.indexOf(name.replace(/[^A-Za-z0-9-]/g, '_') + '_position_' + 'xyz'[axis]);
  if (column < 0) return null;
  const times = data.series.rows.map(row => row[1]);
  let k = times.findIndex(t => t >= time - 1e-12);
  if (k < 0) k = times.length - 1;
  return data.series.rows[k][column];
}

function boxLines(lo, hi, dim) {
  const lines = [], corner = bits => [0, 1, 2].map(c => c < dim ? (bits >> c & 1 ? hi[c] : lo[c]) : 0);
  for (let bits = 0; bits < 1 << dim; ++bits)
    for (let c = 0; c < dim; ++c) if (!(bits >> c & 1)) lines.push(...corner(bits), ...corner(bits | 1 << c));
  return lines;
}

const fieldsOf = view => [
  {key: 'speed', name: 'speed [m/s]', most: view.speed}, {key: 'spin', name: 'spin [1/s]', most: view.spin},
  {key: 'type', name: 'material', kinds: view.materials}, {key: 'rank', name: 'rank', kinds: view.ranks},
  {key: 'radius', name: 'radius [m]', most: view.radius}].filter(f => f.kinds ? f.kinds.length > 0 : f.most > 0);

/** A frame's arrays; what did not change stands in an earlier one. */
function frameArrays(view, index) {
  const frame = view.frames[index];
  if (frame.arrays) return frame.arrays;
  let still = index;
  while (view.frames[still].radius === undefined) --still;
  const of = view.frames[still];
  frame.arrays = {n: frame.n, position: shorts(frame.position), speed: shorts(frame.speed), spin: shorts(frame.spin),
    rank: bytesOf(frame.rank), radius: shorts(of.radius), type: bytesOf(of.type), bonds: frame.bonds ? floats(frame.bonds) : null};
  return frame.arrays;
}

// The map of colours: the same polynomials here and in the shader (a fit of viridis by Matt Zucker, CC0).
const viridis = [[0.2777, 0.0054, 0.3341], [0.1051, 1.4046, 1.3846], [-0.3309, 0.2148, 0.0951], [-4.6342, -5.7991, -19.3324],
  [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.353], [-5.4355, 4.6459, 26.3124]];
function viridisAt(t) {
  return [0, 1, 2].map(c => Math.round(255 * Math.max(0, Math.min(1, viridis.reduceRight((sum, k) => sum * t + k[c], 0)))));
}
function rgb(hex) {
  return [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16));
}
