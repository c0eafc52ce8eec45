// The page in a real browser, against a server that speaks the protocol.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { launch } from './browser.mjs';
import { FakeServer } from './fake_server.mjs';
import { patches } from './fake_scene.mjs';
import { coloursAt, connectionOf, luminance, openedPage, patience, placeOf, shownNumber, until } from './support.mjs';

let browser;

before(async () => (browser = await launch()), { timeout: patience });
after(() => browser?.close());

/// A page on a server of its own.
async function opened(settings = {}, view = {}, whenDone = null) {
  const server = await new FakeServer(settings).listen();
  const parts = await openedPage(browser, server.link, view);
  const close = async () => {
    await parts.context.close();
    await server.close();
  };
  whenDone?.after(close);
  return { server, close, ...parts };
}

/// No camera comes any more.
async function settled(server, page) {
  let count = -1;
  await until(async () => {
    const before = count;
    count = server.commands.filter((command) => command.camera).length;
    await page.waitForTimeout(300);
    return count > 0 && before === count;
  }, 'cameras');
}

const encoded = (v) => 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

function intoGamut(rgb) {
  const y = luminance(rgb);
  if (y >= 1) return [1, 1, 1];
  const kept = Math.min(1, ...rgb.map((v) => (v > 1 ? (1 - y) / (v - y) : v < 0 ? y / (y - v) : 1)));
  return rgb.map((v) => y + kept * (v - y));
}

/// The curve alone: for greys both matrices do nothing, since their rows add up to one.
const filmicGrey = (v) => (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081);
const reinhard = (rgb) => rgb.map((v) => (v * (1 + luminance(rgb) / 2.88 ** 2)) / (1 + luminance(rgb)));

const operators = {
  linear: (rgb) => rgb,
  filmic: (rgb) => (rgb[0] === rgb[1] && rgb[1] === rgb[2] ? rgb.map(filmicGrey) : null),
  reinhard,
};

describe('page', { concurrency: false }, () => {
  let shared; // a page that many tests use, one after the other
  before(async () => (shared = await opened({ passes: 1e6, passMs: 400 })), { timeout: 3 * patience });
  after(async () => shared?.close());

  test('loads, enters with the token, and draws by WebGL2', { timeout: 3 * patience }, async () => {
    const { page, complaints } = shared;
    assert.ok(await page.evaluate(() => document.getElementById('picture').getContext('webgl2') instanceof WebGL2RenderingContext));
    assert.equal(new URL(page.url()).hash, '', 'the token leaves the address');
    assert.match(await page.title(), /spheres/);
    assert.match(await page.textContent('#state'), /Rendering|Finished/);
    assert.deepEqual(complaints, []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollHeight <= 720), 'nothing to scroll at 1280 × 720');
    await page.reload();
    await page.waitForFunction(() => document.documentElement.dataset.connection === 'connected');
  });

  test('shows a radiance in the colour that exposure and operator make of it', { timeout: 3 * patience }, async (t) => {
    const size = { width: 160, height: 120 };
    const { page, complaints } = await opened({ scene: 'chart', ...size, passes: 2 }, {}, t);
    const places = await Promise.all(patches.map((_, i) => placeOf(page, 40 * (i % 4) + 20, 40 * Math.floor(i / 4) + 20, size)));
    const shown = async (operator, exposure) => {
      await page.click(`[data-operator=${operator}]`);
      await page.fill('#exposure-number', String(exposure));
      await page.keyboard.press('Enter');
      await page.mouse.move(640, 10);
      await page.waitForTimeout(300);
      return coloursAt(page, places);
    };
    const distance = (colours, operator, exposure) => Math.max(...patches.map((patch, i) => {
      const made = operators[operator](patch.map((v) => v * 2 ** exposure));
      return made ? Math.max(...intoGamut(made).map((v, c) => Math.abs(encoded(v) - colours[i][c]))) : 0;
    }));
    for (const [operator, exposure] of [['linear', -0.5], ['filmic', 1], ['reinhard', 0.5]]) {
      const colours = await shown(operator, exposure);
      assert.ok(distance(colours, operator, exposure) <= 2, `${operator} at ${exposure}: off by ${distance(colours, operator, exposure)}`);
      assert.ok(distance(colours, operator, exposure + 0.2) > 3, 'a wrong exposure is noticed');
    }
    await page.click('[data-operator=falsecolor]');
    await page.fill('#scale-maximum', '0.9');
    await page.keyboard.press('Enter');
    await page.waitForTimeout(300);
    const [dark, , , bright] = await coloursAt(page, places);
    assert.deepEqual(bright.map((v) => Math.round(v / 8)), [253, 231, 37].map((v) => Math.round(v / 8)), 'the end of viridis');
    assert.ok(dark[2] > dark[1] && dark[0] > 60, 'the beginning of viridis');
    assert.ok(await page.isVisible('#legend'));
    assert.equal(await page.textContent('#legend-unit'), 'W/(sr·m²)');
    assert.deepEqual(complaints, []);
  });

  test('orbits, pans, dollies and changes the angle; the newest camera, at most 30 a second', { timeout: 3 * patience }, async () => {
    const { server, page } = shared;
    const first = server.camera;
    const away = (camera) => Math.hypot(...camera.origin.map((v, c) => v - camera.target[c]));
    const cameras = () => server.commands.filter((command) => command.camera);
    const pixels = server.layers[''].slice();
    const drag = async (dx, dy) => {
      await page.mouse.move(500, 400);
      await page.mouse.down();
      await page.mouse.move(500 + dx, 400 + dy, { steps: 40 });
      await page.mouse.up();
    };
    await drag(150, 40);
    await settled(server, page);
    const orbited = server.camera;
    assert.ok(Math.abs(away(orbited) - away(first)) < 1e-6, 'the distance stays');
    assert.deepEqual(orbited.target, first.target);
    assert.ok(orbited.origin[1] > first.origin[1] + 0.2, 'down lifts the camera');
    const spans = cameras().map(({ at }) => at);
    const inOneSecond = Math.max(...spans.map((t) => spans.filter((u) => u >= t && u < t + 1000).length));
    assert.ok(inOneSecond <= 31, `${inOneSecond} cameras in a second`);
    await until(() => server.layers[''].some((v, i) => v !== pixels[i]), 'another picture');

    await page.keyboard.down('Shift');
    await drag(100, 0);
    await page.keyboard.up('Shift');
    await settled(server, page);
    const moved = server.camera;
    assert.ok(Math.abs(away(moved) - away(first)) < 1e-6);
    assert.notDeepEqual(moved.target, first.target);

    await page.mouse.move(500, 400);
    await page.mouse.wheel(0, -300);
    await until(() => away(server.camera) < away(first) * 0.9, 'nearer');
    await page.keyboard.down('Alt');
    await page.mouse.wheel(0, 300);
    await page.keyboard.up('Alt');
    await until(() => server.camera.fov > first.fov * 1.1, 'a wider angle');
    await page.keyboard.press('h');
    await until(() => Math.abs(away(server.camera) - away(first)) < 1e-6 && server.camera.fov === first.fov, 'home');
  });

  test('two fingers dolly, one orbits', { timeout: 3 * patience }, async (t) => {
    const { server, page, context } = await opened({}, { viewport: { width: 390, height: 844 }, hasTouch: true }, t);
    const first = server.camera;
    const away = (camera) => Math.hypot(...camera.origin.map((v, c) => v - camera.target[c]));
    const box = await page.locator('#stage').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const devtools = await context.newCDPSession(page);
    const touch = (type, ...points) => devtools.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
    await touch('touchStart', [x - 20, y], [x + 20, y]);
    for (let d = 25; d <= 60; d += 5) await touch('touchMove', [x - d, y], [x + d, y]);
    await touch('touchEnd');
    await until(() => away(server.camera) < away(first) / 2, 'nearer');
    await settled(server, page);
    const near = server.camera;
    await touch('touchStart', [x, y]);
    for (let d = 0; d <= 60; d += 6) await touch('touchMove', [x + d, y]);
    await touch('touchEnd');
    await until(() => server.camera.origin[0] !== near.origin[0], 'orbit');
    await settled(server, page);
    assert.ok(Math.abs(away(server.camera) - away(near)) < 1e-6);
  });

  test('the probe tells value, interval, bias and layers; the region its mean', { timeout: 3 * patience }, async () => {
    const size = { width: 160, height: 120 };
    const { server, page } = shared;
    server.state = 'paused';
    const at = await placeOf(page, 80.5, 60.5, size);
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => document.getElementById('probe-x').value === '80' && document.getElementById('probe-y').value === '60');
    const pixel = server.pixel(80, 60);
    await until(async () => Math.abs((await shownNumber(page, '#probe-luminance')) - pixel.luminance) <= pixel.standard_error, 'the luminance');
    const [low, high] = (await page.textContent('#probe-interval')).split(' to ').map(Number);
    assert.ok(Math.abs(low - pixel.interval[0]) < 0.1 * (high - low) && Math.abs(high - pixel.interval[1]) < 0.1 * (high - low));
    assert.notEqual(await page.textContent('#probe-bias'), 'none estimated');
    assert.equal(await page.locator('#probe-layers .layer-row').count(), 4);
    await page.keyboard.press('p');
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => document.getElementById('probe-x').value === '81');

    await page.keyboard.press('r');
    const from = await placeOf(page, 20.2, 30.2, size);
    const to = await placeOf(page, 49.8, 49.8, size);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 5 });
    await page.mouse.up();
    await page.waitForFunction(() => document.getElementById('region-pixels').textContent === '600');
    const mean = server.region(20, 30, 30, 20);
    assert.ok(Math.abs((await shownNumber(page, '#region-mean')) - mean.mean) <= mean.standard_error);
    await page.click('.photometry [value=photometric]');
    assert.equal(await page.textContent('#region-unit'), 'cd/m²');
    assert.ok(Math.abs(parseFloat(await page.textContent('#region-mean')) / (179 * mean.mean) - 1) < 0.01);
    await page.keyboard.press('Escape');
    assert.ok(await page.isVisible('#region-none'));
    server.state = 'rendering';
  });

  test('a region gets more samples, by the button or the key, and tells how far they are', { timeout: 3 * patience }, async (t) => {
    const size = { width: 160, height: 120 };
    const { server, page } = await opened({ ...size, passes: 1e6, passMs: 100 }, {}, t);
    assert.ok(await page.isHidden('#refine'), 'there is no region yet');
    await page.keyboard.press('m');
    await page.keyboard.press('r');
    const from = await placeOf(page, 20.2, 30.2, size);
    const to = await placeOf(page, 49.8, 49.8, size);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 5 });
    await page.mouse.up();
    await page.waitForSelector('#refine:not([hidden])');
    await page.click('#refine-more');
    const asked = () => server.commands.filter(({ refine }) => refine).map(({ refine }) => refine);
    await until(() => asked().length === 1, 'the request');
    assert.deepEqual(asked()[0], { x: 20, y: 30, width: 30, height: 20, passes: 16 });
    await page.waitForFunction(() => /^\d+ of 16 passes of its own/.test(document.getElementById('refine-note').textContent));
    await page.waitForFunction(() => /^16 passes of its own/.test(document.getElementById('refine-note').textContent));
    await page.fill('#refine-passes', '5');
    await page.focus('#stage');
    await page.keyboard.press('m');
    await until(() => asked().length === 2, 'the key');
    assert.equal(asked()[1].passes, 5);
    await page.waitForFunction(() => /^21 passes of its own/.test(document.getElementById('refine-note').textContent));
    server.state = 'idle';
    server.publish();
    await page.waitForFunction(() => document.getElementById('refine-more').disabled);
    await page.keyboard.press('Escape');
    assert.ok(await page.isHidden('#refine'));
    await page.keyboard.press('m');
    await page.waitForTimeout(200);
    assert.equal(asked().length, 2, 'nothing to ask for without a region');
  });

  test('edits go to the server; a refused one is told at its row', { timeout: 3 * patience }, async () => {
    const { server, page } = shared;
    await page.click('#tab-scene');
    const row = (name) => page.locator(`[data-parameter="${name}"]`);
    await row('glass.int_ior').locator('input[type=range]').fill('0.5');
    await until(() => server.value('glass.int_ior').value === 2, 'the slider');
    assert.ok(await row('glass.int_ior').locator('.back').isVisible());
    await row('glass.int_ior').locator('.back').click();
    await until(() => server.value('glass.int_ior').value === 1.5, 'back');
    await row('lamp.radiance').locator('input[type=text]').fill('80');
    await page.keyboard.press('Enter');
    await until(() => Math.abs(server.value('lamp.radiance').value[0] - 80) < 1e-3, 'the colour');
    await row('film.filter').locator('select').selectOption('tent');
    await row('glass.two_sided').locator('input').check();
    await until(() => server.value('film.filter').value === 'tent' && server.value('glass.two_sided').value === true, 'choices');
    await row('glass.roughness').locator('input[type=text]').fill('0.95');
    await page.keyboard.press('Enter');
    await row('glass.roughness').locator('.row-message').waitFor();
    assert.match(await row('glass.roughness').locator('.row-message').textContent(), /out of range.*smaller/);
    assert.equal(server.value('glass.roughness').value, 0);
    assert.equal(await connectionOf(page), 'connected');
    await page.fill('#parameter-filter', 'ior');
    assert.equal(await page.locator('.parameter:visible').count(), 1);
    await page.selectOption('#integrator', 'vcm');
    await until(() => server.integrator === 'vcm', 'the integrator');
  });

  test('where a program renders the scene, what would change it rests', { timeout: 3 * patience }, async (t) => {
    const { server, page } = await opened({ canEdit: false, passes: 1e6 }, {}, t);
    await page.waitForFunction(() => document.querySelector('[data-tool=camera]').disabled);
    for (const id of ['integrator', 'fov', 'home']) assert.ok(await page.isDisabled(`#${id}`), id);
    await page.click('#tab-scene');
    assert.match(await page.textContent('#scene-note:visible'), /only the program can change it/);
    assert.ok(await page.isHidden('#scene-parameters'));
    await page.focus('#stage');
    for (const key of ['c', 'h', '[', ']', 'ArrowLeft']) await page.keyboard.press(key);
    const place = await placeOf(page, 20, 30, { width: 160, height: 120 });
    await page.mouse.move(place.x, place.y);
    await page.mouse.wheel(0, 120);
    await page.keyboard.press('Space');
    await until(() => server.state === 'paused', 'a pause is no change');
    server.state = 'finished';
    server.publish();
    await page.waitForFunction(() => document.getElementById('play').disabled);
    await page.keyboard.press('Space');
    await page.waitForTimeout(200);
    assert.deepEqual(server.commands.map((command) => command.do), ['pause']);
  });

  test('starts, pauses, stops and saves', { timeout: 3 * patience }, async () => {
    const { server, page } = shared;
    server.act('start');
    server.publish();
    await page.waitForFunction(() => document.getElementById('state').textContent === 'Rendering');
    await page.focus('#stage');
    await page.keyboard.press('Space');
    await until(() => server.state === 'paused', 'pause');
    await page.waitForFunction(() => document.getElementById('state').textContent === 'Paused');
    await page.keyboard.press('Space');
    await until(() => server.state === 'rendering', 'resume');
    await page.click('#stop');
    await until(() => server.state === 'idle', 'stop');
    await page.keyboard.press('s');
    await page.fill('#save-name', '../picture.exr');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#save-message:visible');
    assert.ok(!server.commands.some((command) => command.save), 'no folders');
    await page.fill('#save-name', 'view one.exr');
    await page.click('[data-ending=png]');
    await page.click('#save-form [type=submit]');
    await page.waitForSelector('.toast');
    assert.deepEqual(server.commands.filter((command) => command.save).map(({ save }) => save.name), ['view one.png']);
    assert.match(await page.textContent('.toast'), /out\/view one\.png/);
  });

  test('layers are asked for in a form that holds them', { timeout: 3 * patience }, async () => {
    const { page } = shared;
    const asked = [];
    page.on('request', (request) => request.url().includes('/frame?') && asked.push(request.url()));
    for (const [layer, format] of [['error', 'rgb9e5'], ['bias', 'f32'], ['N', 'f32'], ['', 'rgb9e5']]) {
      await page.selectOption('#layer', layer);
      await until(() => asked.some((url) => url.includes(`layer=${layer}&`) && url.includes(`format=${format}`)), `layer ${layer}`);
      await page.waitForFunction((title) => document.getElementById('status-layer').textContent === title, { '': 'Picture', error: 'Error map', bias: 'Bias', N: 'Normals' }[layer]);
      await until(async () => (await page.isVisible('#legend')) === ['error', 'bias'].includes(layer), `legend of layer ${layer}`);
    }
  });

  test('another layer of the same snapshot is drawn; while only the picture is there, it is asked for', { timeout: 3 * patience }, async () => {
    const { server, page } = shared;
    server.state = 'paused';
    await page.waitForTimeout(600);
    const middle = await placeOf(page, 30, 110, server);
    const [floor] = await coloursAt(page, [middle]);
    await page.selectOption('#layer', 'N');
    await until(async () => (await coloursAt(page, [middle]))[0][1] > 240, 'a normal that looks up');
    server.layersThere = [''];
    server.publish();
    await until(async () => (await coloursAt(page, [middle]))[0].every((v, c) => Math.abs(v - floor[c]) < 40), 'the picture');
    assert.equal(await page.inputValue('#layer'), 'N', 'the choice stays');
    server.layersThere = null;
    server.publish();
    await until(async () => (await coloursAt(page, [middle]))[0][1] > 240, 'the normal again');
    await page.selectOption('#layer', '');
    server.state = 'rendering';
  });

  test('photons lie over the picture, in the colours of the legend', { timeout: 3 * patience }, async (t) => {
    const size = { width: 160, height: 120 };
    const { server, page, complaints } = await opened({ scene: 'chart', ...size, passes: 2 }, {}, t);
    server.photons.list = [
      { at: [30.5, 30.5, 7], kind: 'caustic', level: 1, lamp: 0 },
      { at: [30.5, 90.5, -7], kind: 'global', level: 3, lamp: 1 },
      { at: [120.5, 60.5, 0], kind: 'caustic', level: 200, lamp: 1 },
    ];
    const places = await Promise.all(server.photons.list.map(({ at: [x, y] }) => placeOf(page, x, y, size)));
    const bare = await coloursAt(page, places);
    const far = (a, b) => Math.max(...a.map((v, c) => Math.abs(v - b[c])));
    const shows = (colours) => until(async () => {
      const now = await coloursAt(page, places);
      return colours.every((colour, i) => (colour ? far(now[i], colour.map((v, c) => 0.85 * v + 0.15 * bare[i][c])) <= 6 : far(now[i], bare[i]) <= 3));
    }, `points of ${JSON.stringify(colours)}`);
    const [caustic, global, lamp, window] = [[255, 179, 71], [95, 170, 255], [255, 190, 60], [90, 180, 240]];
    await page.focus('#stage');
    await page.keyboard.press('x');
    await shows([caustic, global, caustic]);
    assert.equal(server.photonRequests[0].known, undefined);
    const rows = () => page.locator('#photon-classes button').allTextContents();
    assert.deepEqual(await rows(), ['Indirect1', 'Caustic2']);
    assert.match(await page.textContent('#photon-count'), /^3 of 12/);

    await page.locator('#photon-classes button', { hasText: 'Caustic' }).click();
    await shows([null, global, null]);
    await page.selectOption('#photon-colour', 'lamp');
    assert.deepEqual(await rows(), ['lamp1', 'window2']);
    await shows([lamp, window, window]);
    await page.selectOption('#photon-colour', 'level');
    assert.deepEqual(await rows(), ['11', '31', '8 or more1']);
    await page.selectOption('#photon-colour', 'kind');
    await shows([caustic, global, caustic]);

    // They go with the camera of the picture that is shown.
    server.projection = [1, 0, 0, 15, 0, 1, 0, -5, 0, 0, 0, 1];
    server.publish();
    const moved = await placeOf(page, 45.5, 25.5, size);
    await shows([null, null, null]);
    const [there] = await coloursAt(page, [moved]);
    assert.ok(far(there, caustic) < 60, `moved along: ${there}`);
    server.projection = null;
    server.publish();
    await until(async () => /no points/.test(await page.textContent('#photon-note')), 'why there are none');
    server.projection = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1];
    server.publish();
    await shows([caustic, global, caustic]);

    // After an edit they are asked for, but sent only if they are others.
    const asked = server.photonRequests.length;
    server.edited();
    server.publish();
    await until(() => server.photonRequests.length > asked, 'another request');
    assert.equal(server.photonRequests.at(-1).known, 'a1');
    await shows([caustic, global, caustic]);
    server.photons = { ...server.photons, key: 'b2', list: server.photons.list.slice(0, 1) };
    server.edited();
    server.publish();
    await shows([caustic, null, null]);
    await page.click('#show-photons');
    await shows([null, null, null]);
    assert.ok(await page.isHidden('#photon-legend'));
    assert.deepEqual(complaints, []);
  });

  test('comes back when the server was started again, and asks for a link if the token is new', { timeout: 3 * patience }, async (t) => {
    const { server, page } = await opened({}, {}, t);
    const { port, token } = server;
    const connection = () => connectionOf(page);
    await server.close();
    await until(async () => (await connection()) === 'lost', 'the loss');
    assert.match(await page.textContent('#notice'), /does not answer/);

    const same = await new FakeServer({ token, scene: 'chart' }).listen(port);
    await until(async () => (await connection()) === 'connected', 'the same token');
    await page.waitForFunction(() => document.title.startsWith('chart'));
    await same.close();

    const other = await new FakeServer({}).listen(port);
    await until(async () => (await connection()) === 'locked', 'another token');
    await page.fill('#token', 'http://127.0.0.1/#token=wrong');
    await page.click('#unlock [type=submit]');
    await page.waitForFunction(() => document.getElementById('unlock-message').textContent !== '');
    await page.fill('#token', other.link);
    await page.click('#unlock [type=submit]');
    await until(async () => (await connection()) === 'connected', 'the new token');
    await until(async () => !(await page.isVisible('#notice')), 'no notice');
    await other.close();
  });

  test('fits a phone: nothing is wider than the screen', { timeout: 3 * patience }, async (t) => {
    const { server, page } = await opened({}, { viewport: { width: 390, height: 844 } }, t);
    server.photons.list = [1, 2, 3, 4].map((level) => ({ at: [level, 1, 1], kind: 'global', level, lamp: 0 }));
    await page.click('#show-photons');
    await page.waitForFunction(() => /photons/.test(document.getElementById('photon-count').textContent));
    for (const tab of ['#tab-measure', '#tab-scene', '#tab-log'])
      for (const operator of ['filmic', 'falsecolor']) {
        await page.click(`[data-operator=${operator}]`);
        await page.click(tab);
        const wide = await page.evaluate(() => [
          document.documentElement.scrollWidth,
          ...[...document.querySelectorAll('button, input, select')]
            .filter((element) => element.offsetParent)
            .map((element) => element.getBoundingClientRect().right),
        ]);
        assert.ok(Math.max(...wide) <= 390, `${tab}, ${operator}: ${Math.max(...wide)} px`);
      }
  });

  test('keys, help, dark and light', { timeout: 3 * patience }, async () => {
    const { page } = shared;
    const colour = () => page.evaluate(() => getComputedStyle(document.querySelector('.top')).backgroundColor);
    const dark = await colour();
    await page.emulateMedia({ colorScheme: 'light' });
    await until(async () => (await colour()) !== dark, 'light');
    await page.keyboard.press('t');
    await until(async () => (await colour()) === dark, 'dark');
    await page.keyboard.press('?');
    assert.ok(await page.isVisible('#help-dialog'));
    assert.ok((await page.locator('#help-text dt').count()) > 25);
    await page.keyboard.press('Escape');
    assert.ok(!(await page.isVisible('#help-dialog')));
    for (const [key, tool] of [['v', 'picture'], ['p', 'probe'], ['r', 'region'], ['c', 'camera']]) {
      await page.keyboard.press(key);
      assert.equal(await page.getAttribute('#stage', 'data-tool'), tool);
    }
    const before = Number(await page.inputValue('#exposure-number'));
    await page.keyboard.press('e');
    assert.ok(Math.abs(Number(await page.inputValue('#exposure-number')) - before - 0.5) < 1e-6);
    await page.keyboard.press('v');
    await page.keyboard.press('z');
    await page.waitForFunction(() => document.getElementById('zoom-value').textContent === '100 %');
  });
});
