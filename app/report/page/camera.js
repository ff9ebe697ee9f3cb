// Where the scene is looked at from, and the pointer and keys that change it.

function makeCamera(view) {
  const dim = view.dimension, camera = {yaw: 0, pitch: 0, scale: 1, middle: [0, 0, 0], dim};
  // All of the domain, unless the particles are but a small part of it.
  const isLarge = c => view.box.hi[c] - view.box.lo[c] > 2.5 * (view.hi[c] - view.lo[c]);
  const lo = view.lo.map((x, c) => isLarge(c) ? x : Math.min(x, view.box.lo[c])), hi = view.hi.map((x, c) => isLarge(c) ? x : Math.max(x, view.box.hi[c]));
  const span = c => hi[c] - lo[c];
  camera.reset = (width, height) => {
    camera.middle = [0, 1, 2].map(c => c < dim ? (lo[c] + hi[c]) / 2 : 0);
    camera.yaw = dim === 3 ? -0.5 : 0;
    camera.pitch = dim === 3 ? 0.35 : 0;
    const across = dim === 2 ? span(0) : Math.hypot(span(0), span(1)), up = dim === 2 ? span(1) : span(2) + 0.35 * Math.hypot(span(0), span(1));
    camera.scale = 0.92 * Math.min(width / across, height / up);
  };
  /** Rows of right, up and towards the eye. */
  camera.axes = () => {
    if (dim === 2) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const [cy, sy, cp, sp] = [Math.cos(camera.yaw), Math.sin(camera.yaw), Math.cos(camera.pitch), Math.sin(camera.pitch)];
    return [[cy, sy, 0], [-sy * sp, cy * sp, cp], [sy * cp, -cy * cp, sp]].map(row => row.map(x => x || 0));
  };
  camera.pan = (dx, dy) => {
    const [right, up] = camera.axes();
    camera.middle = camera.middle.map((x, c) => x - (right[c] * dx - up[c] * dy) / camera.scale);
  };
  camera.turn = (dx, dy) => {
    camera.yaw -= dx / 200;
    camera.pitch = Math.max(-1.57, Math.min(1.57, camera.pitch + dy / 200));
  };
  return camera;
}

function steer(canvas, camera, film, draw) {
  let last = null;
  canvas.addEventListener('pointerdown', event => { last = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener('pointerup', () => { last = null; });
  canvas.addEventListener('pointermove', event => {
    if (!last) return;
    const dx = event.clientX - last[0], dy = event.clientY - last[1];
    camera.dim === 3 && !event.shiftKey ? camera.turn(dx, dy) : camera.pan(dx, dy);
    last = [event.clientX, event.clientY];
    draw();
  });
  canvas.addEventListener('wheel', event => {
    camera.scale *= Math.exp(-event.deltaY / 600);
    event.preventDefault();
    draw();
  }, {passive: false});
  canvas.addEventListener('keydown', event => {
    const step = (dx, dy) => camera.dim === 3 && !event.shiftKey ? camera.turn(dx, dy) : camera.pan(dx, dy);
    const act = {ArrowLeft: () => step(30, 0), ArrowRight: () => step(-30, 0), ArrowUp: () => step(0, 30), ArrowDown: () => step(0, -30),
      '+': () => { camera.scale *= 1.3; }, '=': () => { camera.scale *= 1.3; }, '-': () => { camera.scale /= 1.3; },
      0: () => camera.reset(canvas.clientWidth, canvas.clientHeight), ' ': film.toggle, '[': () => film.go(-1), ']': () => film.go(1)}[event.key];
    if (!act) return;
    act();
    event.preventDefault();
    draw();
  });
}
