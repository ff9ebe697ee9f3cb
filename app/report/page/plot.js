// Lines over an axis, with zoom: drag a range, double-click for all; + - 0 and arrows by keyboard.

function ticks(lo, hi, most) {
  const raw = (hi - lo) / most, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(k => k * power).find(k => k >= raw) || 10 * power;
  const found = [];
  for (let t = Math.ceil(lo / step - 1e-9) * step; t <= hi + 1e-9 * step; t += step) found.push(Math.abs(t) < 1e-9 * step ? 0 : t);
  return found;
}

/**
 * @param lines  [{name, points: [{x, y, lo?, hi?, open?}]}]; open: what a click on the point does
 * @param names  {x, y, title}
 */
function plot(lines, names, options = {}) {
  const width = 560, height = 300, left = 76, right = 26, top = 10, bottom = 40;
  const all = lines.flatMap(line => line.points).filter(p => isFinite(p.x) && isFinite(p.y));
  const whole = all.length ? [Math.min(...all.map(p => p.x)), Math.max(...all.map(p => p.x))] : [0, 1];
  if (whole[0] === whole[1]) { whole[0] -= 0.5; whole[1] += 0.5; }
  let view = [...whole];
  const hidden = new Set();
  const svg = make('svg:svg', {class: 'plot', viewBox: `0 0 ${width} ${height}`, tabindex: 0, role: 'group',
    'aria-label': `${names.title || names.y}: ${names.y} over ${names.x}. Plus and minus zoom, arrows move, 0 shows all.`});
  const px = x => left + (x - view[0]) / (view[1] - view[0]) * (width - left - right);
  const back = p => view[0] + (p - left) / (width - left - right) * (view[1] - view[0]);

  function draw() {
    svg.replaceChildren();
    const shown = lines.filter((_, i) => !hidden.has(i)).flatMap(line => line.points)
      .filter(p => p.x >= view[0] && p.x <= view[1] && isFinite(p.y));
    let lo = Math.min(...shown.map(p => p.lo ?? p.y)), hi = Math.max(...shown.map(p => p.hi ?? p.y));
    if (!shown.length) { lo = 0; hi = 1; }
    if (options.fromZero) lo = Math.min(0, lo);
    if (lo === hi) { lo -= Math.abs(lo) / 10 || 0.5; hi += Math.abs(hi) / 10 || 0.5; }
    const py = y => height - bottom - (y - lo) / (hi - lo) * (height - top - bottom);
    for (const t of ticks(lo, hi, 6)) {
      svg.append(make('svg:line', {class: 'grid', x1: left, x2: width - right, y1: py(t), y2: py(t)}));
      svg.append(make('svg:text', {x: left - 6, y: py(t) + 4, 'text-anchor': 'end'}, number(t, 3)));
    }
    for (const t of ticks(view[0], view[1], 7)) {
      svg.append(make('svg:line', {class: 'grid', x1: px(t), x2: px(t), y1: top, y2: height - bottom}));
      svg.append(make('svg:text', {x: px(t), y: height - bottom + 16, 'text-anchor': 'middle'}, number(t, 3)));
    }
    svg.append(make('svg:text', {x: (left + width) / 2, y: height - 6, 'text-anchor': 'middle'}, names.x));
    svg.append(make('svg:text', {x: 12, y: height / 2, 'text-anchor': 'middle', transform: `rotate(-90 12 ${height / 2})`}, names.y));
    lines.forEach((line, i) => { if (!hidden.has(i)) drawLine(line, i, py); });
  }

  function drawLine(line, i, py) {
    const points = line.points.filter(p => isFinite(p.y) && p.x >= view[0] && p.x <= view[1]);
    const every = Math.max(1, Math.floor(points.length / 3000));
    const path = points.filter((_, k) => k % every === 0).map(p => `${px(p.x).toFixed(1)},${py(p.y).toFixed(1)}`).join(' ');
    svg.append(make('svg:polyline', {points: path, fill: 'none', stroke: colour(i), 'stroke-width': 1.8}));
    if (points.length > 60) return;
    for (const p of points) {
      if (p.hi !== undefined && p.hi > p.lo)
        svg.append(make('svg:line', {x1: px(p.x), x2: px(p.x), y1: py(p.lo), y2: py(p.hi), stroke: colour(i), 'stroke-width': 1.2}));
      const label = `${line.name}: ${names.x} ${number(p.x)}, ${names.y} ${number(p.y)}`;
      const mark = make('svg:circle', {cx: px(p.x), cy: py(p.y), r: 4, fill: colour(i)}, make('svg:title', {}, label));
      if (p.open) {
        mark.setAttribute('tabindex', 0);
        mark.setAttribute('role', 'link');
        mark.setAttribute('aria-label', label + '; shows the run');
        mark.style.cursor = 'pointer';
        mark.addEventListener('click', p.open);
        mark.addEventListener('keydown', event => { if (event.key === 'Enter') p.open(); });
      }
      svg.append(mark);
    }
  }

  const zoom = factor => {
    const middle = (view[0] + view[1]) / 2, half = (view[1] - view[0]) / 2 * factor;
    view = [Math.max(whole[0], middle - half), Math.min(whole[1], middle + half)];
    draw();
  };
  const move = share => {
    const by = Math.max(whole[0] - view[0], Math.min(whole[1] - view[1], share * (view[1] - view[0])));
    view = view.map(x => x + by);
    draw();
  };
  svg.addEventListener('keydown', event => {
    const act = {'+': () => zoom(0.5), '=': () => zoom(0.5), '-': () => zoom(2), 0: () => { view = [...whole]; draw(); },
      ArrowLeft: () => move(-0.2), ArrowRight: () => move(0.2)}[event.key];
    if (act && event.target === svg) { act(); event.preventDefault(); }
  });
  const at = event => {
    const box = svg.getBoundingClientRect();
    return Math.max(view[0], Math.min(view[1], back((event.clientX - box.left) / box.width * width)));
  };
  let from = null;
  svg.addEventListener('pointerdown', event => { from = at(event); });
  svg.addEventListener('pointerup', event => {
    if (from === null) return;
    const ends = [from, at(event)].sort((a, b) => a - b);
    from = null;
    if (ends[1] - ends[0] > 0.02 * (view[1] - view[0])) { view = ends; draw(); }
  });
  svg.addEventListener('dblclick', () => { view = [...whole]; draw(); });
  const legend = make('div', {class: 'legend'}, ...lines.map((line, i) => make('button', {type: 'button', 'aria-pressed': 'true',
    onclick: event => {
      hidden.has(i) ? hidden.delete(i) : hidden.add(i);
      event.currentTarget.setAttribute('aria-pressed', String(!hidden.has(i)));
      draw();
    }}, make('span', {class: 'swatch', style: `background:${colour(i)}`}), line.name)));
  draw();
  return make('div', {class: 'plot-box'}, svg, legend);
}
