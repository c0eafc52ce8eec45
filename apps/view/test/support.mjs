// What tests of the page share.
import assert from 'node:assert/strict';
import { readPng } from './png.mjs';

export const patience = 120_000; // machines are busy

/// A page of its own browser profile that has entered by the link. What the browser complains of is
/// kept in `complaints`.
export async function openedPage(browser, link, view = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, colorScheme: 'dark', ...view });
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  await page.goto(link);
  await page.waitForFunction(() => document.getElementById('zoom-value').textContent !== '100 %' && document.getElementById('exposure').value !== '0');
  return { page, context, complaints };
}

export async function until(check, what) {
  const end = Date.now() + patience;
  while (Date.now() < end) {
    const result = await check();
    if (result) return result;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(`waited in vain: ${what}`);
}

/// Where a place of the picture is on the page.
export async function placeOf(page, x, y, { width, height }) {
  const box = await page.locator('#stage').boundingBox();
  const zoom = Math.min(box.width / width, box.height / height);
  return {
    x: box.x + box.width / 2 + (x - width / 2) * zoom,
    y: box.y + box.height / 2 + (y - height / 2) * zoom,
  };
}

export async function coloursAt(page, places) {
  const picture = readPng(await page.screenshot());
  return places.map(({ x, y }) => picture.at(Math.round(x), Math.round(y)));
}

export function connectionOf(page) {
  return page.evaluate(() => document.documentElement.dataset.connection);
}

/// A number as the page writes it, "1.234(5)", without its error.
export async function shownNumber(page, selector) {
  return Number((await page.textContent(selector)).replace(/\(.*/, ''));
}

const photopic = [0.212639, 0.7151687, 0.0721923];
export const luminance = (rgb) => rgb.reduce((sum, v, c) => sum + photopic[c] * v, 0);
