// Segments to click: what must not be touched, as lines for assembly.yaml. The first half is plain arithmetic and runs without a browser.
'use strict';

// Bytes of a base64 text.
function bytesOf(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

// A part of the page's data with its arrays read: vertices (3 n), triangles (3 m), labels (m), middle and radius of its ball.
function readPart(data) {
  const part = {name: data.name, colours: data.colours, kept: new Set(data.keep_off), names: data.names, texts: data.segments, boxes: data.boxes};
  part.given = part.kept.size + part.boxes.length > 0;
  part.vertices = new Float32Array(bytesOf(data.vertices));
  part.triangles = new Uint32Array(bytesOf(data.triangles));
  part.labels = new Uint32Array(bytesOf(data.labels));
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < part.vertices.length; i++) {
    low[i % 3] = Math.min(low[i % 3], part.vertices[i]);
    high[i % 3] = Math.max(high[i % 3], part.vertices[i]);
  }
  part.middle = low.map((v, i) => (v + high[i]) / 2);
  part.radius = Math.hypot(...low.map((v, i) => (high[i] - v) / 2)) || 1;
  return part;
}

// Rows of the rotation from the part to the view: x to the right, y up, z towards the viewer.
function viewRows(yaw, pitch) {
  const c = Math.cos(yaw), s = Math.sin(yaw), d = Math.cos(pitch), e = Math.sin(pitch);
  return [[c, s, 0], [-s * e, c * e, d], [s * d, -c * d, e]];
}

// The ray through a point of the picture, both coordinates from -1 to 1 along the shorter side; the view is parallel.
function viewRay(part, view, x, y) {
  const rows = viewRows(view.yaw, view.pitch), reach = part.radius / view.zoom;
  const at = [x * reach, y * reach, 4 * part.radius];
  return {
    origin: [0, 1, 2].map(i => part.middle[i] + rows[0][i] * at[0] + rows[1][i] * at[1] + rows[2][i] * at[2]),
    direction: rows[2].map(v => -v),
  };
}

// The first triangle that a ray meets, -1: none (Moeller and Trumbore 1997; both sides count).
function pickTriangle(part, ray) {
  const V = part.vertices, T = part.triangles, [ox, oy, oz] = ray.origin, [dx, dy, dz] = ray.direction;
  let best = Infinity, found = -1;
  for (let t = 0; t < T.length; t += 3) {
    const a = 3 * T[t], b = 3 * T[t + 1], c = 3 * T[t + 2];
    const e1x = V[b] - V[a], e1y = V[b + 1] - V[a + 1], e1z = V[b + 2] - V[a + 2];
    const e2x = V[c] - V[a], e2y = V[c + 1] - V[a + 1], e2z = V[c + 2] - V[a + 2];
    const px = dy * e2z - dz * e2y, py = dz * e2x - dx * e2z, pz = dx * e2y - dy * e2x;
    const det = e1x * px + e1y * py + e1z * pz;
    if (det === 0) continue;
    const sx = ox - V[a], sy = oy - V[a + 1], sz = oz - V[a + 2];
    const u = (sx * px + sy * py + sz * pz) / det;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (!(v >= 0 && u + v <= 1)) continue;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / det;
    if (distance > 0 && distance < best) { best = distance; found = t / 3; }
  }
  return found;
}

// The segment at a point of the picture, -1: none.
function pickSegment(part, view, x, y) {
  const triangle = pickTriangle(part, viewRay(part, view, x, y));
  return triangle < 0 ? -1 : part.labels[triangle];
}

function toggle(part, segment) {
  if (!part.kept.delete(segment)) part.kept.add(segment);
}

// What to put under each part in assembly.yaml, instead of what it has there: boxes stay; [] where all was taken away.
function yamlLines(parts) {
  const lines = [];
  for (const part of parts) {
    if (!part.kept.size && !part.given) continue;
    const names = [...part.kept].sort((a, b) => a - b).map(s => part.names[s]);
    lines.push(`  - name: ${JSON.stringify(part.name)}`);
    lines.push(`    keep_off: [${[...names, ...part.boxes].join(', ')}]`);
  }
  return lines.join('\n');
}

if (typeof module !== 'undefined') module.exports = {readPart, viewRay, pickTriangle, pickSegment, toggle, yamlLines};

// ---- the page ----
const KEPT = [0.16, 0.16, 0.18];

function channels(colour) {
  return [1, 3, 5].map(i => parseInt(colour.slice(i, i + 2), 16) / 255);
}

// Corners, normals and colours of every triangle, one after the other.
function corners(part) {
  const n = part.triangles.length, at = new Float32Array(3 * n), normal = new Float32Array(3 * n), colour = new Float32Array(3 * n);
  for (let t = 0; t < n; t += 3) {
    const p = [0, 1, 2].map(k => [0, 1, 2].map(i => part.vertices[3 * part.triangles[t + k] + i]));
    const a = p[1].map((v, i) => v - p[0][i]), b = p[2].map((v, i) => v - p[0][i]);
    const cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const length = Math.hypot(...cross) || 1, label = part.labels[t / 3];
    const shade = part.kept.has(label) ? KEPT : channels(part.colours[label]);
    for (let k = 0; k < 3; k++) for (let i = 0; i < 3; i++) {
      at[3 * (t + k) + i] = p[k][i];
      normal[3 * (t + k) + i] = cross[i] / length;
      colour[3 * (t + k) + i] = shade[i];
    }
  }
  return {at, normal, colour, count: n};
}

const VERTEX = `attribute vec3 at, normal, colour; uniform vec3 right, up, towards, middle; uniform vec2 scale; uniform float depth;
varying vec3 shade; void main() { vec3 p = at - middle; float z = dot(p, towards);
gl_Position = vec4(dot(p, right) * scale.x, dot(p, up) * scale.y, -z * depth, 1.0);
shade = colour * (0.45 + 0.55 * abs(dot(normal, normalize(towards + 0.4 * up + 0.3 * right)))); }`;
const FRAGMENT = 'precision mediump float; varying vec3 shade; void main() { gl_FragColor = vec4(shade, 1.0); }';

class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext('webgl');
    if (!this.gl) return;
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.97, 0.97, 0.96, 1);
    this.program = program;
    this.buffers = {};
  }

  fill(part) {
    if (!this.gl) return;
    const gl = this.gl, data = corners(part);
    for (const name of ['at', 'normal', 'colour']) {
      this.buffers[name] = this.buffers[name] || gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, data[name], gl.STATIC_DRAW);
      const place = gl.getAttribLocation(this.program, name);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
    }
    this.count = data.count;
  }

  draw(part, view) {
    if (!this.gl) return;
    const gl = this.gl, rows = viewRows(view.yaw, view.pitch), {width, height} = this.canvas, side = Math.min(width, height);
    const set = name => gl.getUniformLocation(this.program, name), s = view.zoom / part.radius;
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    ['right', 'up', 'towards'].forEach((name, i) => gl.uniform3fv(set(name), rows[i]));
    gl.uniform3fv(set('middle'), part.middle);
    gl.uniform2f(set('scale'), s * side / width, s * side / height);
    gl.uniform1f(set('depth'), 0.5 / part.radius);
    gl.drawArrays(gl.TRIANGLES, 0, this.count);
  }
}

function startPicker(root, parts) {
  const find = name => root.querySelector(name), canvas = find('canvas'), drawing = new Drawing(canvas);
  const view = {yaw: 0.6, pitch: 0.5, zoom: 0.9};
  let part = parts[0], held = null;
  if (!drawing.gl) find('.picker-note').textContent = 'This browser shows no WebGL: choose by the list.';
  const redraw = () => drawing.draw(part, view);
  const refresh = () => {
    drawing.fill(part);
    redraw();
    const list = find('.picker-list');
    list.textContent = '';
    part.texts.forEach((text, segment) => {
      const label = document.createElement('label'), box = document.createElement('input'), swatch = document.createElement('i');
      box.type = 'checkbox';
      box.checked = part.kept.has(segment);
      box.onchange = () => { toggle(part, segment); refresh(); };
      swatch.style.background = part.colours[segment];
      label.append(box, swatch, ` ${part.names[segment]}${text}`);
      list.append(label);
    });
    find('pre').textContent = yamlLines(parts) || '(nothing chosen)';
  };
  const select = find('select');
  parts.forEach((p, i) => select.append(new Option(p.name, i)));
  select.onchange = () => { part = parts[select.value]; refresh(); };
  canvas.onpointerdown = e => { held = {x: e.clientX, y: e.clientY, moved: 0}; canvas.setPointerCapture(e.pointerId); };
  canvas.onpointermove = e => {
    if (!held) return;
    const dx = e.clientX - held.x, dy = e.clientY - held.y;
    held = {x: e.clientX, y: e.clientY, moved: held.moved + Math.abs(dx) + Math.abs(dy)};
    view.yaw -= dx / 150;
    view.pitch = Math.max(-1.57, Math.min(1.57, view.pitch + dy / 150));
    redraw();
  };
  canvas.onpointerup = e => {
    const still = held && held.moved < 4;
    held = null;
    if (!still) return;
    const box = canvas.getBoundingClientRect(), side = Math.min(box.width, box.height) / 2;
    const x = (e.clientX - box.left - box.width / 2) / side, y = (box.top + box.height / 2 - e.clientY) / side;
    const segment = pickSegment(part, view, x, y);
    if (segment >= 0) { toggle(part, segment); refresh(); }
  };
  canvas.addEventListener('wheel', e => { e.preventDefault(); view.zoom *= Math.exp(-e.deltaY / 600); redraw(); }, {passive: false});
  refresh();
}

if (typeof document !== 'undefined') {
  const root = document.querySelector('.picker');
  startPicker(root, JSON.parse(document.getElementById('picker-data').textContent).map(readPart));
}
