// Draws particles and lines: with WebGL 2 as instances of a square, otherwise as circles on a plain canvas.

const vertexShader = `#version 300 es
in vec2 corner; in vec3 position; in float radius; in float value; in float kind;
uniform vec3 lo, size, middle, right, up, eye; uniform vec2 scale; uniform float most, mostRadius, byKind, depth;
out vec2 at; out float shade; flat out float category; out float z;
void main() {
  vec3 p = lo + position * size - middle;
  float r = radius * mostRadius;
  at = corner; shade = value * most; category = byKind > 0.5 ? kind : -1.0;
  z = r / depth;
  gl_Position = vec4((dot(p, right) + corner.x * r) * scale.x, (dot(p, up) + corner.y * r) * scale.y, -dot(p, eye) / depth, 1.0);
}`;
const fragmentShader = `#version 300 es
precision highp float;
in vec2 at; in float shade; flat in float category; in float z;
uniform vec3 map[7]; uniform vec3 kinds[8]; uniform float solid;
out vec4 colour;
void main() {
  float d = dot(at, at);
  if (d > 1.0) discard;
  float h = sqrt(1.0 - d), t = clamp(shade, 0.0, 1.0);
  vec3 c = map[6];
  for (int k = 5; k >= 0; --k) c = c * t + map[k];
  if (category >= 0.0) c = kinds[int(mod(category, 8.0))];
  float light = solid > 0.5 ? 0.35 + 0.65 * clamp(0.35 * at.x + 0.55 * at.y + 0.75 * h, 0.0, 1.0) : (d > 0.8 ? 0.72 : 1.0);
  gl_FragDepth = gl_FragCoord.z - (solid > 0.5 ? 0.5 * h * z : 0.0);
  colour = vec4(clamp(c, 0.0, 1.0) * light, 1.0);
}`;
const lineVertex = `#version 300 es
in vec3 position; uniform vec3 middle, right, up, eye; uniform vec2 scale; uniform float depth;
void main() { vec3 p = position - middle; gl_Position = vec4(dot(p, right) * scale.x, dot(p, up) * scale.y, -dot(p, eye) / depth - 0.001, 1.0); }`;
const lineFragment = `#version 300 es
precision highp float; uniform vec3 ink; out vec4 colour; void main() { colour = vec4(ink, 1.0); }`;

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return made;
}

/** @return function (picture): {arrays, field, lines: [{points, ink}], camera, width, height, ratio} */
function makeGlDrawer(canvas, view) {
  const gl = canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
  if (!gl) return null;
  const disks = program(gl, vertexShader, fragmentShader), lines = program(gl, lineVertex, lineFragment);
  const square = gl.createBuffer(), buffers = new Map();
  gl.bindBuffer(gl.ARRAY_BUFFER, square);
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
  const attribute = (of, name, size, type, normal, divisor, array) => {
    const place = gl.getAttribLocation(of, name);
    if (place < 0) return;
    if (array !== null) {
      if (!buffers.has(array)) {
        buffers.set(array, gl.createBuffer());
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.get(array));
        gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
      }
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers.get(array));
    } else gl.bindBuffer(gl.ARRAY_BUFFER, square);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, type, normal, 0, 0);
    gl.vertexAttribDivisor(place, divisor);
  };
  const look = (of, {camera, width, height}) => {
    const set = (name, value) => gl['uniform' + value.length + 'fv'](gl.getUniformLocation(of, name), value);
    camera.axes().forEach((axis, k) => set(['right', 'up', 'eye'][k], axis));
    set('middle', camera.middle);
    set('scale', [2 * camera.scale / width, 2 * camera.scale / height]);
    set('depth', [4 * Math.hypot(...view.hi.map((x, c) => x - view.lo[c])) || 1]);
    return set;
  };
  const free = () => { for (const buffer of buffers.values()) gl.deleteBuffer(buffer); buffers.clear(); };
  return picture => {
    const {arrays, field, width, height, ratio} = picture;
    if (buffers.size > 40) free();
    gl.viewport(0, 0, Math.round(width * ratio), Math.round(height * ratio));
    gl.clearColor(...rgb(style('--paper')).map(x => x / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(disks);
    const set = look(disks, picture), dim = view.dimension;
    set('lo', [0, 1, 2].map(c => c < dim ? view.lo[c] : 0));
    set('size', [0, 1, 2].map(c => c < dim ? view.hi[c] - view.lo[c] : 0));
    set('mostRadius', [view.radius]);
    set('solid', [dim === 3 ? 1 : 0]);
    set('most', [field.stretch || 1]);
    set('byKind', [field.kinds ? 1 : 0]);
    gl.uniform3fv(gl.getUniformLocation(disks, 'map'), viridis.flat());
    gl.uniform3fv(gl.getUniformLocation(disks, 'kinds'), palette.flatMap(c => rgb(c).map(x => x / 255)));
    attribute(disks, 'corner', 2, gl.FLOAT, false, 0, null);
    attribute(disks, 'position', dim, gl.UNSIGNED_SHORT, true, 1, arrays.position);
    attribute(disks, 'radius', 1, gl.UNSIGNED_SHORT, true, 1, arrays.radius);
    const values = field.kinds ? arrays.speed : arrays[field.key];
    attribute(disks, 'value', 1, gl.UNSIGNED_SHORT, true, 1, values);
    attribute(disks, 'kind', 1, gl.UNSIGNED_BYTE, false, 1, field.key === 'rank' ? arrays.rank : arrays.type);
    if (dim === 2) gl.disable(gl.DEPTH_TEST);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, arrays.n);
    for (const name of ['position', 'radius', 'value', 'kind', 'corner']) {
      const place = gl.getAttribLocation(disks, name);
      if (place >= 0) { gl.vertexAttribDivisor(place, 0); gl.disableVertexAttribArray(place); }
    }
    gl.useProgram(lines);
    const setLine = look(lines, picture);
    for (const {points, ink} of picture.lines) {
      if (!points.length) continue;
      setLine('ink', rgb(ink).map(x => x / 255));
      const buffer = gl.createBuffer(), place = gl.getAttribLocation(lines, 'position');
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, points instanceof Float32Array ? points : new Float32Array(points), gl.STREAM_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
      gl.drawArrays(gl.LINES, 0, points.length / 3);
      gl.disableVertexAttribArray(place);
      gl.deleteBuffer(buffer);
    }
  };
}

function makePlainDrawer(canvas, view) {
  const pen = canvas.getContext('2d');
  return ({arrays, field, lines, camera, width, height, ratio}) => {
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = style('--paper');
    pen.fillRect(0, 0, width, height);
    const dim = view.dimension, [right, up, eye] = camera.axes();
    const seen = p => {
      const d = p.map((x, c) => x - camera.middle[c]), dot = axis => axis.reduce((s, x, c) => s + x * d[c], 0);
      return [width / 2 + camera.scale * dot(right), height / 2 - camera.scale * dot(up), dot(eye)];
    };
    const dots = [];
    for (let i = 0; i < arrays.n; ++i) {
      const p = [0, 1, 2].map(c => c < dim ? view.lo[c] + arrays.position[dim * i + c] / 65535 * (view.hi[c] - view.lo[c]) : 0);
      dots.push([...seen(p), i]);
    }
    if (dim === 3) dots.sort((a, b) => a[2] - b[2]);
    for (const [x, y, , i] of dots) {
      const value = field.kinds ? 0 : Math.min(1, arrays[field.key][i] / 65535 * (field.stretch || 1));
      pen.fillStyle = field.kinds ? colour(field.key === 'rank' ? arrays.rank[i] : arrays.type[i]) : `rgb(${viridisAt(value)})`;
      pen.beginPath();
      pen.arc(x, y, Math.max(0.5, arrays.radius[i] / 65535 * view.radius * camera.scale), 0, 7);
      pen.fill();
    }
    for (const {points, ink} of lines) {
      pen.strokeStyle = ink;
      for (let k = 0; k + 5 < points.length; k += 6) {
        const [a, b] = [seen([...points.slice(k, k + 3)]), seen([...points.slice(k + 3, k + 6)])];
        pen.beginPath();
        pen.moveTo(a[0], a[1]);
        pen.lineTo(b[0], b[1]);
        pen.stroke();
      }
    }
  };
}

function particlesSection() {
  const view = data.view;
  const canvas = make('canvas', {id: 'scene', tabindex: 0, role: 'img'});
  const slider = make('input', {type: 'range', id: 'frame', min: 0, max: view.frames.length - 1, value: view.frames.length - 1, 'aria-label': 'snapshot'});
  const when = make('output', {for: 'frame'}), choice = make('select', {id: 'field', 'aria-label': 'colour by'});
  const fields = fieldsOf(view), key = make('div', {class: 'legend'});
  choice.append(...fields.map(f => make('option', {value: f.key}, f.name)));
  const hasBonds = view.frames.some(f => f.bonds);
  const bonds = make('input', {type: 'checkbox', checked: true, id: 'bonds'}), walls = make('input', {type: 'checkbox', checked: true, id: 'walls'});
  let timer = null;
  const film = {
    go: by => { slider.value = (Number(slider.value) + by + view.frames.length) % view.frames.length; draw(); },
    toggle: () => {
      timer = timer ? clearInterval(timer) : setInterval(() => film.go(1), 160);
      play.textContent = timer ? 'Pause' : 'Play';
    }};
  const play = make('button', {type: 'button', id: 'play', onclick: film.toggle}, 'Play');
  section('particles', 'Particles', make('div', {class: 'tools'}, view.frames.length > 1 ? play : null, view.frames.length > 1 ? slider : null, when,
    make('label', {}, 'colour by ', choice), hasBonds ? make('label', {}, bonds, ' bonds') : null, make('label', {}, walls, ' walls and domain')), canvas, key,
    make('p', {class: 'note'}, `${view.dimension === 3 ? 'Drag turns, with Shift moves' : 'Drag moves'}; the wheel zooms. Keys: arrows, + and −, 0 shows all`
      + `${view.frames.length > 1 ? ', space plays, [ and ] step' : ''}. ${view.note || ''}`));
  const camera = makeCamera(view);
  let drawer = null;
  try { drawer = makeGlDrawer(canvas, view); } catch (error) { console.warn(error); }
  canvas.dataset.drawer = drawer ? 'webgl2' : 'canvas';
  drawer = drawer || makePlainDrawer(canvas, view);

  function draw() {
    const size = fit(canvas), index = Number(slider.value), frame = view.frames[index], arrays = frameArrays(view, index);
    const field = {...fields.find(f => f.key === choice.value)};
    if (field.most !== undefined && field.key !== 'radius') field.stretch = stretchOf(frame, arrays, field.key);
    const lines = [];
    if (walls.checked) lines.push({points: boxLines(view.box.lo, view.box.hi, view.dimension), ink: style('--line')}, {points: wallLines(view, frame.time), ink: style('--ink')});
    if (bonds.checked && arrays.bonds) lines.push({points: arrays.bonds, ink: style('--accent')});
    drawer({arrays, field, lines, camera, ...size});
    when.textContent = `step ${frame.step.toLocaleString('en')}, ${number(frame.time)} s`;
    canvas.setAttribute('aria-label', `${arrays.n} particles at step ${frame.step}, coloured by ${field.name}`);
    showKey(key, field);
  }
  const start = () => { const size = fit(canvas); camera.reset(size.width, size.height); draw(); };
  slider.addEventListener('input', draw);
  for (const control of [choice, bonds, walls]) control.addEventListener('change', draw);
  steer(canvas, camera, film, draw);
  redraws.push(draw);
  start();
}

/** Few particles may be much faster than all others: the scale ends at the 99th percentile of the frame. */
function stretchOf(frame, arrays, key) {
  frame.stretch = frame.stretch || {};
  if (frame.stretch[key] === undefined) {
    const sorted = Uint16Array.from(arrays[key]).sort();
    frame.stretch[key] = 65535 / Math.max(1, sorted[Math.floor(0.99 * (sorted.length - 1))] || 1);
  }
  return frame.stretch[key];
}

function showKey(key, field) {
  key.replaceChildren();
  if (field.kinds) {
    key.append(...field.kinds.slice(0, 32).map((name, i) => make('span', {}, make('span', {class: 'swatch', style: `background:${colour(i)}`}), name)));
    return;
  }
  const stops = Array.from({length: 9}, (_, k) => `rgb(${viridisAt(k / 8)})`).join(',');
  key.append(make('span', {}, '0 ', make('span', {class: 'swatch', style: `width:180px;background:linear-gradient(90deg,${stops})`}),
    `${number(field.most / (field.stretch || 1), 3)}${field.stretch > 1.01 ? ' and more' : ''}`));
}
