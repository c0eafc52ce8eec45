// Speaks the protocol of `kaustik view` without a renderer, for tests of the page.
//   node test/fake_server.mjs [--port N] [--token T] [--size WxH] [--picture file.pfm]
import { createServer } from 'node:http';
import { randomBytes } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chartLayers, givenLayers, noise, rgb9e5, sceneLayers } from './fake_scene.mjs';

const dist = join(dirname(fileURLToPath(import.meta.url)), '../dist');
const assets = {
  '/': ['index.html', 'text/html; charset=utf-8'],
  '/app.js': ['app.js', 'text/javascript; charset=utf-8'],
  '/app.css': ['app.css', 'text/css; charset=utf-8'],
  '/icon.svg': ['icon.svg', 'image/svg+xml'],
};
const photopic = [0.212639, 0.7151687, 0.0721923];
const luminance = (rgb) => photopic[0] * rgb[0] + photopic[1] * rgb[1] + photopic[2] * rgb[2];

const parameter = (name, kind, value, more = {}) => ({ name, kind, value, default: value, ...more });

function objects() {
  return [
    { id: 'lamp', family: 'emitter', type: 'area', parameters: [
      parameter('radiance', 'color', [40, 36, 30], { minimum: 0, unit: 'W/(sr·m²)', about: 'Radiance of the lamp.' }),
      parameter('sampling_weight', 'number', 1, { minimum: 0, about: 'How often the lamp is chosen, beside the others.' }),
    ] },
    { id: 'glass', family: 'bsdf', type: 'dielectric', parameters: [
      parameter('int_ior', 'number', 1.5, { minimum: 1, maximum: 3, about: 'Index of refraction inside.' }),
      parameter('roughness', 'number', 0, { minimum: 0, maximum: 1, about: 'Roughness of the surface.' }),
      parameter('two_sided', 'boolean', false, { about: 'Whether both sides look the same.' }),
    ] },
    { id: 'film', family: 'film', type: 'hdrfilm', parameters: [
      parameter('filter', 'choice', 'gaussian', { choices: ['box', 'tent', 'gaussian', 'mitchell'], about: 'Filter of pixels.' }),
      parameter('exposure', 'number', 0, { minimum: -10, maximum: 10, unit: 'stops', about: 'Exposure of the film.' }),
    ] },
    { id: 'integrator', family: 'integrator', type: 'auto', parameters: [
      parameter('max_depth', 'integer', 12, { minimum: 1, about: 'Most vertices of a path.' }),
      parameter('photons', 'integer', 200000, { minimum: 1000, about: 'Photons of a pass.' }),
    ] },
  ];
}

export class FakeServer {
  constructor({ width = 160, height = 120, token = randomBytes(16).toString('hex'), scene = 'spheres', picture = null, passes = 64, hasNoise = scene !== 'chart', passMs = 150, canEdit = true } = {}) {
    Object.assign(this, { width, height, token, sceneKind: scene, given: picture, goal: passes, hasNoise, passMs, canEdit });
    this.cookie = randomBytes(16).toString('hex');
    this.commands = [];
    this.objects = objects();
    this.integrator = 'auto';
    this.camera = { origin: [3, 3.2, 7], target: [0, 0.8, 0], up: [0, 1, 0], fov: 38 };
    Object.assign(this, { number: 0, revision: 1, passes: 0, state: 'rendering', elapsed: 0, movedAt: -Infinity, refusal: null, regions: [] });
    this.history = { elapsed_s: [], error: [] };
    // Photons lie at pixels: this camera sees along parallel lines.
    this.projection = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1];
    this.photons = { key: 'a1', lamps: ['lamp', 'window'], list: [] };
    this.photonRequests = [];
    this.waiting = new Set();
    this.listeners = new Set();
    this.trace();
  }

  async listen(port = 0) {
    this.server = createServer((request, response) => this.answer(request, response).catch((error) => {
      console.error(error);
      response.writeHead(500).end();
    }));
    await new Promise((done) => this.server.listen(port, '127.0.0.1', done));
    this.port = this.server.address().port;
    this.timer = setInterval(() => this.pass(), this.passMs);
    return this;
  }

  get address() {
    return `http://127.0.0.1:${this.port}/`;
  }

  get link() {
    return `${this.address}#token=${this.token}`;
  }

  async close() {
    clearInterval(this.timer);
    for (const stop of this.waiting) stop();
    this.server.closeAllConnections();
    await new Promise((done) => this.server.close(() => done()));
  }

  value(name) {
    const [id, key] = name.split('.');
    return this.objects.find((o) => o.id === id)?.parameters.find((p) => p.name === key);
  }

  trace() {
    const scene = { radiance: this.value('lamp.radiance').value };
    if (this.sceneKind === 'chart') this.layers = chartLayers(this.width, this.height);
    else if (this.given) this.layers = givenLayers(this.given);
    else this.layers = sceneLayers(this.width, this.height, this.camera, scene);
  }

  pass() {
    if (this.isStale) {
      this.isStale = false;
      this.trace();
    }
    const isMoving = Date.now() - this.movedAt < 400;
    if (this.state !== 'rendering') return isMoving && this.publish();
    this.elapsed += this.passMs / 1000;
    const refined = this.regions.find(({ waiting }) => waiting > 0);
    if (refined) {
      refined.passes += 1;
      refined.waiting -= 1;
      return this.publish();
    }
    this.passes += 1;
    if (this.hasNoise && this.passes >= 2) {
      this.history.elapsed_s.push(this.elapsed);
      this.history.error.push(0.35 / Math.sqrt(this.passes) * (1 + 0.06 * noise(7, this.passes)));
      this.send('error_history', this.history);
    }
    if (this.passes >= this.goal) this.state = 'finished';
    this.publish();
  }

  publish() {
    this.number += 1;
    this.send('state', this.told());
    for (const go of this.waiting) go();
  }

  told() {
    return {
      program: '0.1.0', scene: this.sceneKind, revision: this.revision, state: this.state, failure: null,
      refusal: this.refusal, width: this.width, height: this.height, passes: this.passes,
      samples: this.passes * this.width * this.height, elapsed_s: this.elapsed,
      error: this.history.error.at(-1) ?? null, is_moving: Date.now() - this.movedAt < 400,
      regions: this.regions, integrator: this.integrator,
      layers: this.layersThere ?? ['', 'direct', 'caustic', 'indirect', 'emission', 'error', 'bias', 'albedo', 'N', 'depth'],
      unit: 'W/(sr·m²)', camera: this.camera, can_edit: this.canEdit,
    };
  }

  /// Of one pixel, of any layer.
  rgb(layer, x, y) {
    const i = y * this.width + x;
    const of = (name) => [0, 1, 2].map((c) => this.layers[name][3 * i + c]);
    if (layer === 'error') return of('').map((v) => this.deviation(v));
    if (layer === 'bias') return of('caustic').map((v) => 0.03 * v * noise(i, 1));
    const value = of(layer);
    if (!this.hasNoise || ['albedo', 'N', 'depth', 'emission'].includes(layer)) return value;
    return value.map((v) => Math.max(0, v + 1.7 * this.deviation(v) * noise(i, this.passes)));
  }

  deviation(value) {
    return this.hasNoise ? (0.3 * value + 0.002) / Math.sqrt(Math.max(1, this.passes)) : 0;
  }

  async answer(request, response) {
    const url = new URL(request.url, 'http://fake');
    const headers = {
      'Content-Security-Policy': "default-src 'self'", 'X-Content-Type-Options': 'nosniff', 'Cache-Control': 'no-store',
    };
    const json = (status, body) => response.writeHead(status, { ...headers, 'Content-Type': 'application/json' }).end(JSON.stringify(body));
    if (request.method === 'GET' && assets[url.pathname]) {
      const [name, type] = assets[url.pathname];
      return response.writeHead(200, { ...headers, 'Content-Type': type }).end(readFileSync(join(dist, name)));
    }
    if (request.method === 'POST' && url.pathname === '/session') return this.login(await bodyOf(request), response, json);
    if (!(request.headers.cookie ?? '').includes(`kaustik_${this.port}=${this.cookie}`))
      return json(403, { error: 'no session', remedy: 'open the link that the program printed' });
    if (request.method === 'POST' && url.pathname === '/command') return this.command(await bodyOf(request), json);
    const at = (name) => Number(url.searchParams.get(name) ?? 0);
    if (url.pathname === '/state') return json(200, this.told());
    if (url.pathname === '/parameters') return json(200, { objects: this.objects, integrators: ['auto', 'path', 'vcm', 'photonmap'] });
    if (url.pathname === '/pixel') return json(200, this.pixel(at('x'), at('y')));
    if (url.pathname === '/region') return json(200, this.region(at('x'), at('y'), at('width'), at('height')));
    if (url.pathname === '/photons') return this.sendPhotons(url.searchParams, response, headers);
    if (url.pathname === '/frame') return this.frame(url.searchParams, request, response, headers);
    if (url.pathname === '/events') return this.events(request, response, headers);
    return json(404, { error: `nothing is at ${url.pathname}`, remedy: 'see the protocol' });
  }

  login({ token }, response, json) {
    if (token !== this.token) return json(403, { error: 'wrong token', remedy: 'open the link that the program printed' });
    response.writeHead(204, { 'Set-Cookie': `kaustik_${this.port}=${this.cookie}; HttpOnly; SameSite=Strict; Path=/` }).end();
  }

  events(request, response, headers) {
    response.writeHead(200, { ...headers, 'Content-Type': 'text/event-stream' });
    const listener = (name, value) => response.write(`event: ${name}\ndata: ${JSON.stringify(value)}\n\n`);
    this.listeners.add(listener);
    request.on('close', () => this.listeners.delete(listener));
    listener('state', this.told());
    listener('error_history', this.history);
    listener('log', { level: 'info', text: `Scene ${this.sceneKind}: 4 objects, 2 threads of 2 cores` });
  }

  send(name, value) {
    for (const listener of this.listeners) listener(name, value);
  }

  log(level, text) {
    this.send('log', { level, text });
  }

  async frame(query, request, response, headers) {
    const after = Number(query.get('after') ?? 0);
    if (this.number <= after) await this.newer(request);
    if (request.destroyed || response.writableEnded) return;
    if (this.number <= after) return response.writeHead(204, headers).end();
    const { body, width, height } = this.pixels(query.get('layer') ?? '', query.get('format') ?? 'rgb9e5', Number(query.get('width') ?? 0));
    response.writeHead(200, {
      ...headers, 'Content-Type': 'application/octet-stream', 'X-Number': this.number, 'X-Revision': this.revision,
      'X-Kind': 'passes', 'X-Passes': this.passes, 'X-Width': width, 'X-Height': height, 'X-Scale': 0.5,
      'X-Moving': Date.now() - this.movedAt < 400 ? 1 : 0,
      ...(this.projection ? { 'X-Projection': this.projection.join(' ') } : {}),
    }).end(body);
  }

  /// Each photon is {at: [x, y, z], kind, level, lamp}.
  sendPhotons(query, response, headers) {
    this.photonRequests.push(Object.fromEntries(query));
    const { key, lamps, list } = this.photons;
    if (query.get('known') === key) return response.writeHead(204, headers).end();
    const kinds = ['global', 'caustic', 'volume'];
    let text = JSON.stringify({ count: list.length, total: 12345, key, kinds, lamps });
    text = text.padEnd(4 * Math.ceil(text.length / 4));
    const body = Buffer.alloc(4 + text.length + 28 * list.length);
    body.writeUInt32LE(text.length, 0);
    body.write(text, 4, 'latin1');
    list.forEach(({ at, kind, level, lamp }, i) => {
      const start = 4 + text.length + 28 * i;
      at.forEach((v, axis) => body.writeFloatLE(v, start + 4 * axis));
      [1, 2, 3].forEach((v, lane) => body.writeFloatLE(v, start + 12 + 4 * lane));
      body.writeUInt8(kinds.indexOf(kind), start + 24);
      body.writeUInt8(level, start + 25);
      body.writeUInt16LE(lamp, start + 26);
    });
    response.writeHead(200, { ...headers, 'Content-Type': 'application/octet-stream' }).end(body);
  }

  newer(request) {
    return new Promise((done) => {
      const go = () => {
        clearTimeout(timer);
        this.waiting.delete(go);
        done();
      };
      const timer = setTimeout(go, 25000);
      this.waiting.add(go);
      request.on('close', go);
    });
  }

  /// Reduced by whole numbers, so that they are no wider than asked; twice their size, for X-Scale.
  pixels(layer, format, widest) {
    const by = widest > 0 ? Math.max(1, Math.ceil(this.width / widest)) : 1;
    const [width, height] = [Math.floor(this.width / by), Math.floor(this.height / by)];
    const body = Buffer.alloc(width * height * (format === 'f32' ? 12 : 4));
    for (let y = 0; y < height; ++y)
      for (let x = 0; x < width; ++x) {
        const sum = [0, 0, 0];
        for (let v = 0; v < by; ++v)
          for (let u = 0; u < by; ++u) this.rgb(layer, x * by + u, y * by + v).forEach((value, c) => (sum[c] += value));
        const rgb = sum.map((value) => (2 * value) / (by * by));
        const i = y * width + x;
        if (format === 'f32') rgb.forEach((value, c) => body.writeFloatLE(value, 12 * i + 4 * c));
        else body.writeUInt32LE(rgb9e5(...rgb), 4 * i);
      }
    return { body, width, height };
  }

  pixel(x, y) {
    const value = this.rgb('', x, y);
    const error = this.hasNoise ? this.deviation(luminance(value)) : null;
    const layers = Object.fromEntries(['direct', 'caustic', 'indirect', 'emission'].map((name) => [name, this.rgb(name, x, y)]));
    return {
      x, y, value, luminance: luminance(value), standard_error: error,
      interval: error === null ? null : [luminance(value) - 1.96 * error, luminance(value) + 1.96 * error],
      bias: this.hasNoise ? this.rgb('bias', x, y) : null, layers, passes: this.passes,
    };
  }

  region(x, y, width, height) {
    let sum = 0;
    for (let v = y; v < y + height; ++v) for (let u = x; u < x + width; ++u) sum += luminance(this.rgb('', u, v));
    const mean = sum / (width * height);
    const error = this.hasNoise ? this.deviation(mean) / Math.sqrt(width * height) : null;
    return { mean, standard_error: error, interval: error === null ? null : [mean - 1.96 * error, mean + 1.96 * error], pixels: width * height };
  }

  command(command, json) {
    this.commands.push({ at: Date.now(), ...command });
    if (command.save) {
      if (/[\\/]|^\./.test(command.save.name)) return json(400, { error: 'no plain name', remedy: 'leave out folders' });
      return json(200, { file: `out/${command.save.name}` });
    }
    if (command.set) {
      const refused = this.set(command.set);
      if (refused) return json(422, refused);
    }
    if (command.camera) {
      this.camera = command.camera;
      this.movedAt = Date.now();
    }
    if (command.integrator) this.integrator = command.integrator;
    if (command.refine) {
      const { passes, ...region } = command.refine;
      if (region.x + region.width > this.width) return json(400, { error: 'no such region', remedy: 'stay within the picture' });
      const known = this.regions.find(({ x, y, width, height }) => x === region.x && y === region.y && width === region.width && height === region.height);
      if (known) known.waiting += passes;
      else this.regions.push({ ...region, passes: 0, waiting: passes });
    }
    if (command.do) this.act(command.do);
    if (command.camera || command.set || command.integrator || command.do === 'reset') this.edited();
    else this.publish();
    return json(200, { revision: this.revision });
  }

  set(edits) {
    for (const [name, value] of Object.entries(edits)) {
      const parameter = this.value(name);
      if (!parameter) return { error: `unknown parameter '${name}'`, remedy: 'see parameters' };
      if (value > (parameter.maximum ?? Infinity) || value < (parameter.minimum ?? -Infinity) || (name === 'glass.roughness' && value > 0.9))
        return { error: `${name} = ${value} is out of range`, remedy: 'choose a smaller value' };
      parameter.value = value;
    }
    return null;
  }

  act(action) {
    if (action === 'reset') this.objects = objects();
    this.state = { start: 'rendering', resume: 'rendering', pause: 'paused', stop: 'idle' }[action] ?? this.state;
    if (action === 'start' && this.passes >= this.goal) this.edited();
  }

  edited() {
    this.revision += 1;
    this.passes = 0;
    this.regions = [];
    this.elapsed = 0;
    this.history = { elapsed_s: [], error: [] };
    this.state = this.state === 'finished' ? 'rendering' : this.state;
    this.isStale = true;
    this.send('error_history', this.history);
  }
}

async function bodyOf(request) {
  let text = '';
  for await (const part of request) text += part;
  return JSON.parse(text || '{}');
}

/// A PFM picture's pixels, rows from the top.
export function readPfm(file) {
  const bytes = readFileSync(file);
  const [, width, height, scale] = /^PF\s+(\d+)\s+(\d+)\s+(\S+)\s/.exec(bytes.subarray(0, 100).toString('latin1')) ?? [];
  const [w, h] = [Number(width), Number(height)];
  const start = bytes.length - 12 * w * h;
  const pixels = new Float32Array(3 * w * h);
  for (let y = 0; y < h; ++y)
    for (let i = 0; i < 3 * w; ++i) {
      const at = start + 4 * (3 * w * (h - 1 - y) + i);
      pixels[3 * w * y + i] = Number(scale) < 0 ? bytes.readFloatLE(at) : bytes.readFloatBE(at);
    }
  return { width: w, height: h, pixels };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const option = (name) => process.argv[process.argv.indexOf(`--${name}`) + 1];
  const has = (name) => process.argv.includes(`--${name}`);
  const [width, height] = (has('size') ? option('size') : '640x480').split('x').map(Number);
  const given = has('picture') ? readPfm(option('picture')) : null;
  const server = await new FakeServer({
    width: given?.width ?? width, height: given?.height ?? height, picture: given?.pixels ?? null,
    ...(has('token') ? { token: option('token') } : {}), passes: 256, passMs: 500,
  }).listen(has('port') ? Number(option('port')) : 0);
  console.log(server.link);
}
