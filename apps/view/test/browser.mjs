// Debian's Chromium, driven by playwright-core, with WebGL2 in software.
import { chromium } from 'playwright-core';

const args = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync', '--disable-renderer-backgrounding', '--disable-gpu-compositing', '--disable-gpu-rasterization',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];

export function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, args });
}
