// The pictures of docs/guides/live_view.md, of the program itself in Chromium: node test/docs_pictures.mjs [FOLDER [SECONDS]]
// KAUSTIK names the program. Each scene renders for so many seconds at rest, 30 unless told.
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch } from './browser.mjs';
import { RealServer } from './real_server.mjs';
import { openedPage, placeOf, until } from './support.mjs';

const [folder = join(dirname(fileURLToPath(import.meta.url)), '../../../docs/pictures'), seconds = '30'] = process.argv.slice(2);
const quality = 82;
const size = { width: 384, height: 384 };
const options = ['-D', `size=${size.width}`];
const saved = mkdtempSync(join(tmpdir(), 'kaustik_pictures_'));
const browser = await launch();

/// Shows a scene that has rendered for its time and has some errors to plot, to `shoot(page, server)`.
async function shown(scene, view, shoot) {
  const server = await RealServer.start({ scene, folder: saved, options: [...options, ...(view.options ?? [])] });
  const { page, context } = await openedPage(browser, server.link, view.context);
  await until(async () => {
    const state = await server.get('state');
    return !state.is_moving && state.elapsed_s >= Number(seconds) && state.passes >= 4;
  }, `${seconds} s of ${scene}`);
  await shoot(page, server);
  await context.close();
  await server.stop();
}

const click = async (page, x, y) => {
  const at = await placeOf(page, x, y, size);
  await page.mouse.click(at.x, at.y);
};
const drag = async (page, from, to) => {
  const [a, b] = await Promise.all([from, to].map(([x, y]) => placeOf(page, x, y, size)));
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move(b.x, b.y, { steps: 6 });
  await page.mouse.up();
};
const shot = (page, name, more = {}) => page.screenshot({ path: join(folder, `view_${name}.jpg`), type: 'jpeg', quality, ...more });

await shown('cornell_spheres', {}, async (page) => {
  await page.keyboard.press('v');
  await click(page, 268, 350);
  await page.keyboard.press('r');
  await drag(page, [112, 112], [202, 187]);
  await page.waitForFunction(() => !document.getElementById('region-values').hidden);
  await page.mouse.move(0, 0);
  await page.waitForTimeout(1500);
  await shot(page, 'measure');
});

await shown('metal_ring', {}, async (page) => {
  await page.keyboard.press('v');
  await click(page, 238, 176);
  await page.keyboard.press('x');
  await page.waitForFunction(() => /\d/.test(document.getElementById('photon-count').textContent));
  await page.mouse.move(0, 0);
  await page.waitForTimeout(2000);
  await shot(page, 'photons');
});

const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 };
await shown('metal_ring', { context: phone }, async (page) => {
  await page.keyboard.press('v');
  await click(page, 238, 176);
  await page.waitForTimeout(1500);
  await shot(page, 'phone', { scale: 'css' });
});

await browser.close();
rmSync(saved, { recursive: true });
