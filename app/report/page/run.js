// What a run says in numbers.

function seriesSection() {
  const {columns, rows} = data.series;
  const time = columns.indexOf('time'), numbers = columns.filter((c, i) => i > 1 && rows.some(row => typeof row[i] === 'number'));
  const groups = [['energies [J]', numbers.filter(c => c.endsWith('_energy'))], ['contacts', ['contacts', 'bonds', 'broken_bonds'].filter(c => numbers.includes(c))],
    ['largest overlap [m]', ['max_overlap'].filter(c => numbers.includes(c))], ['largest speed [m/s]', ['max_speed'].filter(c => numbers.includes(c))],
    ['forces on walls [N]', numbers.filter(c => /_force_[xyz]$/.test(c))], ['positions of walls [m]', numbers.filter(c => /_position_[xyz]$/.test(c))],
    ['diameters of rings [m]', numbers.filter(c => /^ring\d+_diameter/.test(c))], ['momentum [N·s]', numbers.filter(c => /^momentum_/.test(c))]];
  const of = names => names.map(c => ({name: c.replaceAll('_', ' '), points: rows.map(row => ({x: row[time], y: row[columns.indexOf(c)]})).filter(p => typeof p.y === 'number')}))
    .filter(line => line.points.some(p => p.y !== 0));
  const plots = groups.map(([name, names]) => [name, of(names)]).filter(([, lines]) => lines.length)
    .map(([name, lines]) => plot(lines, {x: 'time [s]', y: name, title: 'Series'}));
  section('series', 'Series', make('div', {class: 'two'}, ...plots),
    make('p', {class: 'note'}, 'Drag over a plot zooms, a double-click shows all; names in the legend hide their line. Keys: + and −, arrows, 0.'));
}

function bar(parts, label) {
  const sum = parts.reduce((s, [, v]) => s + v, 0) || 1;
  const element = make('div', {class: 'bar', role: 'img', 'aria-label': label + ': ' + parts.map(([n, v]) => `${n} ${percent(v / sum)}`).join(', ')});
  parts.forEach(([name, value], i) => element.append(make('span', {style: `width:${100 * value / sum}%;background:${colour(i)}`, title: `${name}: ${percent(value / sum)}`})));
  return element;
}

function communicationSection() {
  const run = data.run, steps = Math.max(1, run.loop_steps ?? run.steps), us = seconds => 1e6 * seconds / steps, times = run.communication;
  const phases = Object.entries(run.phases).sort((a, b) => b[1] - a[1]).filter(([, v]) => v > 0);
  const parts = [make('p', {}, make('strong', {}, percent(times.hidden_fraction)), ` of the communication was hidden: ${number(us(times.in_flight_seconds))} µs a step in flight, ` +
    `${number(us(times.exposed_seconds))} µs exposed. A step took ${number(us(run.loop_seconds))} µs on the slowest rank.`), bar(phases, 'Phases of a step'),
    table(['phase', 'mean [µs a step]', 'slowest rank', 'share'], phases.map(([name, s], i) => [make('span', {}, make('span', {class: 'swatch', style: `background:${colour(i)}`}), name),
      us(s), us(run.phases_most?.[name] ?? s), percent(s / phases.reduce((t, [, v]) => t + v, 0))]))];
  const kinds = ['halo', 'rebuild', 'reductions'].filter(kind => times[kind]);
  if (run.ranks > 1) parts.push(make('h3', {}, 'Messages'), table(['', 'in flight [µs a step]', 'exposed', 'late'],
    kinds.map(kind => [kind, us(times[kind].in_flight_seconds), us(times[kind].exposed_seconds), times[kind].late_seconds === undefined ? '–' : us(times[kind].late_seconds)])),
    make('p', {class: 'note'}, `${number(times.messages)} messages, ${number(times.bytes / 2 ** 20)} MiB, of all ranks.`));
  section('communication', 'Communication', ...parts);
}

function balanceSection() {
  const owned = data.run.particles_of_ranks || [];
  if (owned.length < 2) return;
  const most = Math.max(...owned), mean = owned.reduce((s, n) => s + n, 0) / owned.length;
  section('balance', 'Balance', make('p', {}, `The largest rank holds ${number(most / mean, 3)} times the mean.`),
    table(['rank', 'particles', ''], owned.slice(0, 256).map((n, i) => [String(i), n, make('div', {style: `width:240px`}, make('div', {style: `height:12px;background:${colour(0)};width:${100 * n / most}%`}))])));
}

function choiceSection() {
  const choice = data.run.exchange_choice || {};
  if (!choice.reason) return;
  const rows = (choice.measured || []).map(m => [m.exchange, m.obstacle ? '–' : 1e6 * m.exposed_seconds, m.obstacle ? '–' : 1e6 * m.half_round_trip_seconds, m.obstacle || '']);
  section('exchange', 'Exchange', make('p', {}, choice.reason), ...(rows.length ? [make('p', {class: 'note'}, `As measured at the start, between these ranks, with messages of ${number(choice.message_bytes)} bytes.`),
    table(['exchange', 'adds to a step [µs]', 'half trip [µs]', ''], rows)] : []), ...(choice.hint ? [make('p', {class: 'note'}, choice.hint)] : []));
}

function wordsSection(id, title, object) {
  const rows = Object.entries(object).map(([key, value]) => [key, typeof value === 'object' ? JSON.stringify(value) : value]);
  section(id, title, table(null, rows, 'words'));
}
