// A sweep: step against delay or ranks, hidden share, scaling, and its runs.

const unitsOf = {ns: 1e-3, us: 1, 'µs': 1, ms: 1e3, s: 1e6, kbit: 1e-3, mbit: 1, gbit: 1e3, '': 1};
/** A value along an axis as a number; delays in µs. Not a number for words. */
function measureOf(text) {
  const found = /^([-+0-9.e]+?)([a-zµ]*)$/.exec(text);
  return found && found[2] in unitsOf ? Number(found[1]) * unitsOf[found[2]] : NaN;
}
const middleOf = values => {
  const sorted = [...values].sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};
const unitName = axis => axis === 'delay' ? 'one-way delay [µs]' : axis;

function sweepPoints() {
  return data.sweep.points.map((entry, index) => ({...entry, index}));
}

/** Lines of points along an axis, one for each combination of the others. */
function linesAlong(points, axis, axes, x, y) {
  const lines = new Map();
  for (const p of points) {
    const name = axes.filter(a => a !== axis).map(a => p.point[a]).join(', ') || 'all';
    const values = p.runs.map(y), at = x(p);
    if (!isFinite(at) || !values.every(isFinite)) continue;
    if (!lines.has(name)) lines.set(name, []);
    lines.get(name).push({x: at, y: middleOf(values), lo: Math.min(...values), hi: Math.max(...values), open: () => showPoint(p.index)});
  }
  return [...lines].map(([name, of]) => ({name, points: of.sort((a, b) => a.x - b.x)}));
}

function showPoint(index) {
  document.querySelectorAll('tr.chosen').forEach(row => row.classList.remove('chosen'));
  const row = document.getElementById('point-' + index);
  row.classList.add('chosen');
  row.scrollIntoView({block: 'center'});
  row.querySelector('a').focus();
}

function sweepSections() {
  const points = sweepPoints(), axes = data.sweep.axes, numeric = axes.filter(a => points.every(p => isFinite(measureOf(p.point[a]))));
  const names = {step: ['step [µs]', r => r.step_us], hidden: ['hidden share', r => r.hidden], exposed: ['exposed [µs a step]', r => r.exposed_us]};
  const along = (axis, key, scale) => plot(linesAlong(points, axis, axes, p => measureOf(p.point[axis]) , scale || names[key][1]),
    {x: unitName(axis), y: names[key][0], title: 'Sweep'}, {fromZero: true});
  if (numeric.length) {
    const choice = make('select', {id: 'axis', 'aria-label': 'axis'}, ...numeric.map(a => make('option', {value: a, selected: a === 'delay'}, unitName(a))));
    const box = make('div', {class: 'two'});
    const draw = () => {
      const axis = choice.value, found = [along(axis, 'step'), along(axis, 'exposed'), along(axis, 'hidden')];
      if (axis === 'delay') found.push(plot(linesAlong(points.filter(p => measureOf(p.point.delay) > 0), 'delay', axes,
        p => middleOf(p.runs.map(r => r.work_us)) / measureOf(p.point.delay), r => r.hidden), {x: 'work of a step per delay', y: 'hidden share', title: 'Sweep'}, {fromZero: true}));
      if (axis === 'ranks') found.push(scaling(points, axes));
      box.replaceChildren(...found);
    };
    choice.addEventListener('change', draw);
    section('curves', 'Curves', make('div', {class: 'tools'}, make('label', {}, 'along ', choice)), box,
      make('p', {class: 'note'}, 'Medians of the repetitions, with the least and the most of them. A click on a point, or Enter, shows its runs.'));
    draw();
  }
  const head = [...axes, 'runs', 'step [µs]', 'spread', 'ratio', 'work [µs]', 'in flight [µs]', 'exposed [µs]', 'hidden', 'others', 'run'];
  const rows = points.map(p => [...axes.map(a => p.point[a]), p.runs.length, p.step_us, percent(p.spread), p.ratio === null ? '–' : p.ratio.toFixed(3), p.work_us,
    p.in_flight_us, p.exposed_us, percent(p.hidden), p.others.toFixed(2), make('span', {}, ...p.runs.flatMap(r => [make('a', {href: r.link}, String(r.repetition)), ' ']))]);
  const made = table(head, rows);
  [...made.querySelectorAll('tbody tr')].forEach((row, i) => row.setAttribute('id', 'point-' + i));
  section('runs', 'Runs', made, make('p', {class: 'note'}, `Ratio: of the step to that of ${data.sweep.base}. Others: cores that other processes used meanwhile; above 0.2 times are rough. `
    + (data.sweep.digests_equal ? 'Digests are equal wherever the deck is.' : 'Runs of one deck ended with different digests.')));
}

/** Speed-up over the fewest ranks, and what would be ideal. */
function scaling(points, axes) {
  const lines = linesAlong(points, 'ranks', axes, p => measureOf(p.point.ranks), r => r.step_us);
  const all = lines.flatMap(line => line.points.map(p => p.x)), least = Math.min(...all), most = Math.max(...all);
  const up = lines.filter(line => line.points[0].x === least).map(line => ({name: line.name, points: line.points.map(p => ({...p, y: line.points[0].y / p.y, lo: undefined, hi: undefined}))}));
  return plot([...up, {name: 'ideal', points: [{x: least, y: 1}, {x: most, y: most / least}]}], {x: 'ranks', y: 'speed-up', title: 'Scaling'}, {fromZero: true});
}
