// What every worker did when, with messages as arrows from their sender to who noticed them.

const sliceColours = {chunk: 0, 'left band': 2, 'right band': 5, send: 4, poll: 7, wait: 1, rebuild: 6, migration: 3, ghosts: 3, reduction: 6};

function timelineSection() {
  const trace = data.trace, rows = [];
  for (const [rank, workers] of trace.workers.entries()) for (let w = 0; w < workers; ++w) rows.push([rank, w]);
  const rowHeight = 30, head = 24, left = 96;
  const canvas = make('canvas', {tabindex: 0, role: 'img', style: `height:${head + rows.length * rowHeight + 8}px`});
  const told = make('output', {class: 'note', 'aria-live': 'polite'}, 'Point at a slice, or press Tab and the arrows.');
  const arrows = make('input', {type: 'checkbox', checked: true, id: 'arrows'});
  const names = [...new Set(trace.slices.map(s => trace.names[s[2]]))];
  section('timeline', 'Timeline', make('div', {class: 'tools'}, make('label', {}, arrows, ' messages'),
    make('button', {type: 'button', onclick: () => { view = [...firstView]; draw(); }}, 'Two steps'),
    make('button', {type: 'button', onclick: () => { view = [...whole]; draw(); }}, 'All')), canvas, told,
    make('div', {class: 'legend'}, ...names.map(n => make('span', {}, make('span', {class: 'swatch', style: `background:${colour(sliceColours[n] ?? 7)}`}), n))),
    make('p', {class: 'note'}, `Steps ${trace.steps[0]} to ${trace.steps[1]} of the trace. The wheel zooms, drag moves; keys: arrows, + and −, 0 shows all. ` +
      'Slices nest: a send lies inside its band.'));
  const end = Math.max(...trace.slices.map(s => s[3] + s[4])), whole = [0, end];
  const early = trace.slices.filter(s => s[5] < trace.steps[0] + 2), firstView = [0, early.length ? Math.max(...early.map(s => s[3] + s[4])) : end];
  let view = [...firstView], picked = -1;
  const pen = canvas.getContext('2d');
  const rowOf = (rank, worker) => rows.findIndex(row => row[0] === rank && row[1] === worker);
  const nested = new Set(['send', 'poll', 'migration', 'ghosts', 'shadows']);
  const y = row => head + row * rowHeight;
  let px = null;

  function draw() {
    const {width, ratio} = fit(canvas), height = canvas.clientHeight;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = style('--paper');
    pen.fillRect(0, 0, width, height);
    px = t => left + (t - view[0]) / (view[1] - view[0]) * (width - left - 6);
    pen.font = '12px system-ui, sans-serif';
    pen.fillStyle = style('--soft');
    rows.forEach(([rank, worker], r) => pen.fillText(`rank ${rank}${trace.workers[rank] > 1 ? `, ${worker}` : ''}`, 6, y(r) + 18));
    for (const t of ticks(view[0], view[1], 8)) {
      pen.fillStyle = style('--grid');
      pen.fillRect(px(t), head - 6, 1, height);
      pen.fillStyle = style('--soft');
      pen.fillText(number(t) + ' µs', px(t) + 3, 14);
    }
    pen.save();
    pen.beginPath();
    pen.rect(left, 0, width - left, height);
    pen.clip();
    trace.slices.forEach((s, i) => drawSlice(s, i));
    if (arrows.checked) trace.messages.forEach(drawArrow);
    pen.restore();
    canvas.setAttribute('aria-label', `Timeline of ${rows.length} workers from ${number(view[0])} to ${number(view[1])} microseconds`);
  }

  function drawSlice([rank, worker, name, begin, length], i) {
    if (begin > view[1] || begin + length < view[0]) return;
    const row = rowOf(rank, worker), word = trace.names[name], inner = nested.has(word);
    const x = px(begin), w = Math.max(0.6, px(begin + length) - x);
    pen.fillStyle = colour(sliceColours[word] ?? 7);
    pen.fillRect(x, y(row) + (inner ? 9 : 3), w, inner ? 12 : 24);
    if (i === picked) { pen.strokeStyle = style('--ink'); pen.lineWidth = 2; pen.strokeRect(x, y(row) + 2, w, 26); }
    if (w > 46 && !inner) { pen.fillStyle = '#fff'; pen.fillText(word, x + 4, y(row) + 19); }
  }

  function drawArrow([from, fromWorker, sent, to, toWorker, noticed]) {
    if (sent > view[1] || noticed < view[0]) return;
    const a = [px(sent), y(rowOf(from, fromWorker)) + 15], b = [px(noticed), y(rowOf(to, toWorker)) + 15];
    pen.strokeStyle = pen.fillStyle = style('--ink');
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(...a);
    pen.lineTo(...b);
    pen.stroke();
    const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
    pen.beginPath();
    pen.moveTo(...b);
    for (const turn of [2.75, -2.75]) pen.lineTo(b[0] + 7 * Math.cos(angle + turn), b[1] + 7 * Math.sin(angle + turn));
    pen.fill();
  }

  const tell = i => {
    const [rank, worker, name, begin, length, step] = trace.slices[i];
    told.textContent = `rank ${rank}, worker ${worker}: ${trace.names[name]}, ${number(length)} µs from ${number(begin)} µs on, step ${step}`;
  };
  const pick = by => {
    const n = trace.slices.length;
    picked = picked < 0 ? trace.slices.findIndex(s => s[3] >= view[0]) : (picked + by + n) % n;
    tell(picked);
    const [, , , begin, length] = trace.slices[picked];
    if (begin < view[0] || begin + length > view[1]) { const w = view[1] - view[0]; view = [begin - w / 4, begin + 3 * w / 4]; }
  };
  const zoom = (factor, about) => { view = view.map(t => about + (t - about) * factor); };
  const middle = () => (view[0] + view[1]) / 2;
  canvas.addEventListener('keydown', event => {
    const act = {'+': () => zoom(0.6, middle()), '=': () => zoom(0.6, middle()), '-': () => zoom(1.6, middle()), 0: () => { view = [...whole]; },
      ArrowRight: () => pick(1), ArrowLeft: () => pick(-1)}[event.key];
    if (!act) return;
    act();
    event.preventDefault();
    draw();
  });
  const timeAt = event => {
    const box = canvas.getBoundingClientRect();
    return view[0] + (event.clientX - box.left - left) / (box.width - left - 6) * (view[1] - view[0]);
  };
  canvas.addEventListener('wheel', event => { zoom(Math.exp(event.deltaY / 500), timeAt(event)); event.preventDefault(); draw(); }, {passive: false});
  let last = null;
  canvas.addEventListener('pointerdown', event => { last = event.clientX; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener('pointerup', () => { last = null; });
  canvas.addEventListener('pointermove', event => {
    if (last !== null) {
      const by = (last - event.clientX) / (canvas.clientWidth - left) * (view[1] - view[0]);
      view = view.map(t => t + by);
      last = event.clientX;
      return draw();
    }
    const t = timeAt(event), row = Math.floor((event.clientY - canvas.getBoundingClientRect().top - head) / rowHeight);
    let found = -1;
    trace.slices.forEach((s, i) => { if (rows[row] && s[0] === rows[row][0] && s[1] === rows[row][1] && s[3] <= t && s[3] + s[4] >= t) found = i; });
    if (found >= 0) tell(found);
  });
  arrows.addEventListener('change', draw);
  redraws.push(draw);
  draw();
}
