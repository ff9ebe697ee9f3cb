'use strict';
// Small tools of all parts of the page.
const data = JSON.parse(document.getElementById('data').textContent);
const palette = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#b38600', '#56b4e9', '#8b5fbf', '#7f7f7f'];
const colour = i => palette[((i % palette.length) + palette.length) % palette.length];

/** An element with attributes, then children: elements or texts. SVG where its name says so. */
function make(name, attributes = {}, ...children) {
  const element = name.startsWith('svg:') ? document.createElementNS('http://www.w3.org/2000/svg', name.slice(4))
                                          : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value === true ? '' : value);
  }
  element.append(...children.filter(child => child !== null));
  return element;
}

/** Three or four significant digits, thousands apart. */
function number(value, digits = 4) {
  if (value === null || value === undefined || value === '') return '–';
  if (typeof value !== 'number') return String(value);
  if (value === 0 || !isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-3) return value.toExponential(digits - 1).replace(/\.?0+e/, 'e');
  return size >= 10 ** digits ? Math.round(value).toLocaleString('en') : String(Number(value.toPrecision(digits)));
}
const percent = share => (share > 0 && share < 0.0995 ? (100 * share).toFixed(1) : Math.round(100 * share)) + ' %';

/** A section of the page, listed in its navigation. */
function section(id, title, ...children) {
  const heading = make('h2', {id: id + '-title'}, title);
  const element = make('section', {id, 'aria-labelledby': id + '-title'}, heading, ...children);
  document.querySelector('main').append(element);
  document.querySelector('nav').append(make('a', {href: '#' + id}, title));
  return element;
}

/** A table; rows are arrays of texts or elements. */
function table(head, rows, kind = '') {
  const line = (cells, name) => make('tr', {}, ...cells.map(cell => make(name, name === 'th' ? {scope: 'col'} : {}, cell)));
  return make('div', {class: 'scroll'}, make('table', {class: kind}, head ? make('thead', {}, line(head, 'th')) : null,
    make('tbody', {}, ...rows.map(cells => line(cells.map(c => typeof c === 'number' ? number(c) : c), 'td')))));
}

function bytesOf(text) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}
const shorts = text => new Uint16Array(bytesOf(text).buffer);
const floats = text => new Float32Array(bytesOf(text).buffer);

const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const redraws = [];  // of what does not follow the colours by itself
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => redraws.forEach(redraw => redraw()));
window.addEventListener('resize', () => redraws.forEach(redraw => redraw()));

/** A canvas as large as it is shown, on screens of any density. @return its size in CSS pixels */
function fit(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  return {width, height, ratio};
}
