// The page in a real browser, against `kaustik view` itself: KAUSTIK names the program.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { launch } from './browser.mjs';
import { readExr } from './exr.mjs';
import { RealServer } from './real_server.mjs';
import { coloursAt, connectionOf, luminance, openedPage, patience, placeOf, shownNumber, until } from './support.mjs';

const size = { width: 72, height: 72 };
// Paths have errors of pixels after two passes, and passes are short.
const shown = { scene: 'cornell_spheres', options: ['-D', `size=${size.width}`, '--integrator', 'path'] };
const token = 'a-token_of-20-letters';
const longest = { timeout: 3 * patience };

describe('page on kaustik view', { concurrency: false }, () => {
  let browser, server, folder, page, complaints;

  before(async () => {
    folder = mkdtempSync(join(tmpdir(), 'kaustik_view_'));
    [browser, server] = await Promise.all([launch(), RealServer.start({ ...shown, folder, token })]);
    ({ page, complaints } = await openedPage(browser, server.link));
  }, longest);

  after(async () => {
    await browser?.close();
    await server?.stop();
    rmSync(folder, { recursive: true });
  });

  const state = () => server.get('state');

  /// The scene's own integrator has so many passes, and the page knows it.
  async function rested(passes) {
    await until(async () => {
      const now = await state();
      return !now.is_moving && now.passes >= passes;
    }, `${passes} passes at rest`);
    await page.waitForFunction((n) => Number(document.getElementById('passes').textContent) >= n, passes);
  }

  async function paused() {
    await page.focus('#stage');
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.getElementById('state').textContent === 'Paused');
    // Threads rest when they are done with what they had begun.
    let before;
    await until(async () => {
      const last = before;
      before = JSON.stringify([await server.get('pixel?x=1&y=1'), (await state()).passes]);
      await page.waitForTimeout(300);
      return last === before;
    }, 'rest');
  }

  async function resumed() {
    await page.focus('#stage');
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.getElementById('state').textContent === 'Rendering');
  }

  /// By the page's dialog; the picture as it was written.
  async function saved(name) {
    await page.focus('#stage');
    await page.keyboard.press('s');
    await page.fill('#save-name', name);
    await page.keyboard.press('Enter');
    await page.locator('.toast', { hasText: name }).waitFor();
    return readExr(readFileSync(join(folder, name)));
  }

  /// Files hold halves.
  const isNear = (a, b) => Math.abs(a - b) <= 2 ** -10 * Math.abs(b) + 1e-6;
  const rgbOf = (picture, x, y, layer = '') => ['R', 'G', 'B'].map((c) => picture.channels[layer + c][y * picture.width + x]);

  test('has the page that was tested', longest, async () => {
    for (const name of ['index.html', 'app.js', 'app.css', 'icon.svg']) {
      const served = Buffer.from(await (await fetch(server.address(name))).arrayBuffer());
      assert.ok(served.equals(readFileSync(new URL(`../dist/${name}`, import.meta.url))), `${name} is another one: build kaustik anew`);
    }
  });

  test('enters, and shows the picture', longest, async () => {
    assert.equal(new URL(page.url()).hash, '');
    assert.match(await page.title(), /cornell_spheres/);
    await rested(3);
    const walls = await Promise.all([[8, 36], [64, 36]].map(([x, y]) => placeOf(page, x, y, size)));
    const [red, green] = await coloursAt(page, walls);
    assert.ok(Math.abs(red[0] - red[1]) > 20, `a coloured wall on the left: ${red}`);
    assert.ok(Math.abs(green[0] - green[1]) > 20, `a coloured wall on the right: ${green}`);
    assert.ok((red[0] > red[1]) !== (green[0] > green[1]), 'one is red, the other green');
    assert.deepEqual(complaints, []);
  });

  test('the probe tells what the saved file holds', longest, async () => {
    await rested(3);
    await paused();
    const [x, y] = [50, 60];
    const at = await placeOf(page, x + 0.5, y + 0.5, size);
    await page.mouse.click(at.x, at.y);
    const picture = await saved('probe.exr');
    assert.deepEqual([picture.width, picture.height], [size.width, size.height]);
    const told = await server.get(`pixel?x=${x}&y=${y}`);
    const stored = rgbOf(picture, x, y);
    told.value.forEach((value, c) => assert.ok(isNear(value, stored[c]), `channel ${c}: ${value}, in the file ${stored[c]}`));
    const wrong = rgbOf(picture, x + 1, y);
    assert.ok(told.value.some((value, c) => !isNear(value, wrong[c])), 'the pixel beside it is noticed');
    for (const layer of ['direct', 'indirect', 'albedo']) {
      const part = rgbOf(picture, x, y, `${layer}.`);
      told.layers[layer].forEach((value, c) => assert.ok(isNear(value, part[c]), `${layer} ${c}: ${value}, in the file ${part[c]}`));
    }
    assert.ok(told.standard_error > 0 && told.interval[0] < told.luminance && told.interval[1] > told.luminance);

    await page.waitForFunction(([px, py]) => document.getElementById('probe-x').value === px && document.getElementById('probe-y').value === py, [String(x), String(y)]);
    await until(async () => Math.abs((await shownNumber(page, '#probe-luminance')) - luminance(stored)) <= told.standard_error, 'the luminance');
    for (const [c, name] of ['r', 'g', 'b'].entries())
      assert.ok(Math.abs(Number(await page.textContent(`#probe-${name}`)) / stored[c] - 1) < 0.01, name);
    await resumed();
  });

  test('the region tells the mean of the saved file', longest, async () => {
    await rested(3);
    await paused();
    await page.keyboard.press('r');
    const from = await placeOf(page, 20.2, 50.2, size);
    const to = await placeOf(page, 39.8, 61.8, size);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 5 });
    await page.mouse.up();
    await page.waitForFunction(() => document.getElementById('region-pixels').textContent === '240');
    const picture = await saved('region.exr');
    let mean = 0;
    for (let py = 50; py < 62; ++py) for (let px = 20; px < 40; ++px) mean += luminance(rgbOf(picture, px, py)) / 240;
    const told = await server.get('region?x=20&y=50&width=20&height=12');
    assert.ok(isNear(told.mean, mean), `${told.mean}, in the file ${mean}`);
    assert.ok(told.standard_error > 0 && told.standard_error < mean);
    const onPage = await shownNumber(page, '#region-mean');
    assert.ok(Math.abs(onPage - mean) <= told.standard_error, `${onPage} on the page, in the file ${mean}`);
    await page.keyboard.press('Escape');
    await page.keyboard.press('c');
    await resumed();
  });

  test('a region gets more samples, and the saved file has them', longest, async () => {
    await rested(3);
    await page.keyboard.press('r');
    const from = await placeOf(page, 20.2, 50.2, size);
    const to = await placeOf(page, 39.8, 61.8, size);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 5 });
    await page.mouse.up();
    await page.fill('#refine-passes', '40');
    await page.click('#refine-more');
    await page.waitForFunction(() => /^40 passes of its own/.test(document.getElementById('refine-note').textContent), null, { timeout: 60000 });
    await paused();
    const inside = await server.get('pixel?x=30&y=55');
    const outside = await server.get('pixel?x=60&y=55');
    assert.equal(inside.passes - outside.passes, 40);
    const picture = await saved('refined.exr');
    for (const told of [inside, outside])
      told.value.forEach((value, c) => assert.ok(isNear(value, rgbOf(picture, told.x, told.y)[c]), `channel ${c} at ${told.x}`));
    await page.keyboard.press('Escape');
    await page.keyboard.press('c');
    await resumed();
  });

  test('a picture that is there already stays', longest, async () => {
    writeFileSync(join(folder, 'mine.exr'), 'mine');
    await page.focus('#stage');
    await page.keyboard.press('s');
    await page.fill('#save-name', 'mine.exr');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#save-message:visible');
    assert.match(await page.textContent('#save-message'), /already/);
    assert.equal(readFileSync(join(folder, 'mine.exr'), 'utf8'), 'mine');
    await page.click('#save-cancel');
    // The browser tells of every refusal itself.
    assert.ok(complaints.splice(0).every((text) => text.includes('409')));
  });

  test('a drag orbits, and the picture follows', longest, async () => {
    await rested(2);
    const before = await state();
    const away = ({ origin, target }) => Math.hypot(...origin.map((v, c) => v - target[c]));
    const middle = await placeOf(page, 36, 36, size);
    const places = await Promise.all([[20, 50], [40, 50], [60, 50], [30, 20]].map(([x, y]) => placeOf(page, x, y, size)));
    const old = await coloursAt(page, places);
    await page.mouse.move(middle.x, middle.y);
    await page.mouse.down();
    await page.mouse.move(middle.x + 120, middle.y + 20, { steps: 12 });
    await page.mouse.up();
    await until(async () => (await state()).revision > before.revision, 'another revision');
    await until(async () => {
      const now = await coloursAt(page, places);
      return now.some((rgb, i) => rgb.some((v, c) => Math.abs(v - old[i][c]) > 25));
    }, 'another picture');
    await rested(1);
    const turned = (await state()).camera;
    assert.ok(Math.abs(away(turned) / away(before.camera) - 1) < 1e-4, 'the distance stays');
    assert.ok(Math.hypot(...turned.origin.map((v, c) => v - before.camera.origin[c])) > 0.05, 'the camera is elsewhere');
    await page.keyboard.press('h');
    await until(async () => Math.hypot(...(await state()).camera.origin.map((v, c) => v - before.camera.origin[c])) < 1e-4, 'home');
    await rested(1);
    assert.deepEqual(complaints, []);
  });

  test('photons of the caustic lie where the picture is bright', longest, async () => {
    await rested(2);
    await page.focus('#stage');
    await page.keyboard.press('x');
    await page.waitForFunction(() => / of /.test(document.getElementById('photon-count').textContent));
    const shown = await page.locator('#photon-classes button').allTextContents();
    assert.ok(shown.some((row) => row.startsWith('Caustic')) && shown.some((row) => row.startsWith('Indirect')), shown.join());
    // What the glass ball focuses on the floor, below it: many points, and much light.
    const frame = await server.ask('frame?after=0&format=f32');
    const projection = frame.headers.get('x-projection').split(' ').map(Number);
    const bytes = Buffer.from(await (await server.ask('photons?max=20000')).arrayBuffer());
    const start = 4 + bytes.readUInt32LE(0);
    const { count } = JSON.parse(bytes.toString('utf8', 4, start));
    const density = new Float64Array(size.width * size.height);
    for (let i = 0; i < count; ++i) {
      const at = start + 28 * i;
      if (bytes[at + 24] !== 1) continue;
      const point = [0, 4, 8].map((axis) => bytes.readFloatLE(at + axis)).concat(1);
      const [x, y, w] = [0, 4, 8].map((row) => point.reduce((sum, v, c) => sum + projection[row + c] * v, 0));
      const [px, py] = [Math.floor(x / w), Math.floor(y / w)];
      if (w > 0 && px >= 0 && py >= 0 && px < size.width && py < size.height) density[py * size.width + px] += 1;
    }
    const densest = density.indexOf(Math.max(...density));
    const [x, y] = [densest % size.width, Math.floor(densest / size.width)];
    const told = await server.get(`pixel?x=${x}&y=${y}`);
    const around = (await server.get(`region?x=${Math.max(0, x - 10)}&y=${Math.max(0, y - 5)}&width=10&height=5`)).mean;
    assert.ok(density[densest] > 20 && told.luminance > 2 * around, `${density[densest]} photons, ${told.luminance} beside ${around}`);
    await page.keyboard.press('x');
    assert.deepEqual(complaints, []);
  });

  test('an edit makes another picture; one that is refused does not', longest, async () => {
    await rested(2);
    const dark = (await server.get('region?x=10&y=10&width=50&height=50')).mean;
    const { revision } = await state();
    await page.click('#tab-scene');
    const row = page.locator('[data-parameter="emitter.scale"]');
    await row.locator('input[type=text]').fill('4');
    await page.keyboard.press('Enter');
    await until(async () => (await state()).revision > revision, 'another revision');
    await rested(2);
    const bright = (await server.get('region?x=10&y=10&width=50&height=50')).mean;
    // The same numbers: but for how many passes there are, exactly.
    assert.ok(Math.abs(bright / dark / 4 - 1) < 0.2, `four times as much light gives ${bright / dark}`);

    const now = (await state()).revision;
    const refused = await server.ask('command', { set: { 'emitter.scale': -1 } });
    assert.equal(refused.status, 400);
    const { error, remedy } = await refused.json();
    assert.ok(error && remedy);
    assert.equal((await state()).revision, now);
    await page.click('#undo-edits');
    await until(async () => (await state()).revision > now, 'the scene as it was');
    await rested(2);
    const again = (await server.get('region?x=10&y=10&width=50&height=50')).mean;
    assert.ok(Math.abs(again / dark - 1) < 0.2);
    await page.click('#tab-measure');
    assert.deepEqual(complaints, []);
  });

  test('what one page changes the other shows', longest, async (t) => {
    const other = await openedPage(browser, server.link);
    t.after(() => other.context.close());
    await other.page.click('#tab-scene');
    await page.click('#tab-scene');
    const field = (on) => on.locator('[data-parameter="dielectric.int_ior"] input[type=text]');
    for (const on of [page, other.page]) await on.click('[data-object="dielectric"] summary');
    await until(async () => (await field(other.page).inputValue()) === '1.5', 'the value before');
    await field(page).fill('1.3');
    await page.keyboard.press('Enter');
    await until(async () => (await field(other.page).inputValue()) === '1.3', 'the value');
    const origin = await other.page.textContent('#camera-origin');
    await page.focus('#stage');
    for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowLeft');
    await until(async () => (await other.page.textContent('#camera-origin')) !== origin, 'the camera');
    await until(async () => (await other.page.textContent('#camera-origin')) === (await page.textContent('#camera-origin')), 'the same camera');
    await rested(1);
    const numbers = async (on) => Number(await on.textContent('#passes'));
    await until(async () => (await numbers(other.page)) > 0 && Math.abs((await numbers(other.page)) - (await numbers(page))) <= 2, 'the same passes');
    await page.click('#undo-edits');
    await page.click('#tab-measure');
    assert.deepEqual([...complaints, ...other.complaints], []);
  });

  test('comes back when the program was started again with the same token', longest, async () => {
    const { port } = server;
    assert.equal(await server.stop(), 0, 'Ctrl-C is no failure');
    await until(async () => (await connectionOf(page)) === 'lost', 'the loss');
    server = await RealServer.start({ scene: 'metal_ring', folder, token, port, options: ['-D', 'size=64', '--integrator', 'path'] });
    await until(async () => (await connectionOf(page)) === 'connected', 'the same token');
    await page.waitForFunction(() => document.title.startsWith('metal_ring'));
    await rested(1);
    const middle = await placeOf(page, 32, 50, { width: 64, height: 64 });
    await until(async () => (await coloursAt(page, [middle]))[0].some((v) => v > 40), 'its picture');
  });
});
