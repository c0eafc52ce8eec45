// Pictures of the page, to look at: node test/pictures.mjs FOLDER [LINK]
// Without a link it shows what the fake server makes.
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { launch } from './browser.mjs';
import { FakeServer } from './fake_server.mjs';

const [folder = 'test/pictures', link] = process.argv.slice(2);
await mkdir(folder, { recursive: true });
const server = link ? null : await new FakeServer({ width: 480, height: 360, passMs: 400 }).listen();
const browser = await launch();
const sizes = { desk: { width: 1280, height: 720 }, phone: { width: 390, height: 844 } };
for (const [name, viewport] of Object.entries(sizes))
  for (const colorScheme of ['dark', 'light']) {
    const page = await browser.newPage({ viewport, colorScheme });
    const shot = (what) => page.screenshot({ path: join(folder, `${name}_${colorScheme}_${what}.png`), fullPage: name === 'phone' });
    await page.goto(link ?? server.link);
    await page.waitForSelector('#readout', { state: 'attached' });
    await page.waitForTimeout(4000);
    const box = await page.locator('#stage').boundingBox();
    await page.mouse.click(box.x + box.width * 0.38, box.y + box.height * 0.6);
    await page.keyboard.press('r');
    await page.mouse.move(box.x + box.width * 0.42, box.y + box.height * 0.66);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.85, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(1500);
    await shot('measure');
    await page.click('[data-operator=falsecolor]');
    await page.click('#tab-scene');
    await page.waitForTimeout(1500);
    await shot('scene');
    if (name === 'desk') {
      await page.keyboard.press('2');
      await page.keyboard.press('v');
      for (let i = 0; i < 20; ++i) {
        await page.mouse.move(box.x + box.width * 0.42, box.y + box.height * 0.5);
        await page.mouse.wheel(0, -100);
      }
      await page.click('#tab-log');
      await page.waitForTimeout(1500);
      await shot('pixels');
      await page.keyboard.press('?');
      await page.waitForTimeout(300);
      await shot('help');
      await page.keyboard.press('Escape');
      await page.click('#save');
      await shot('save');
    }
    await page.close();
  }
await browser.close();
await server?.close();
