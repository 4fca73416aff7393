/** A headless Chromium over CDP, as the tests need it. */
import puppeteer from 'puppeteer-core';
import { existsSync } from 'node:fs';

const PLACES = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
export const chromium = PLACES.find((place) => place && existsSync(place));

export function launch() {
  const args = ['--no-sandbox', '--disable-dev-shm-usage', '--enable-unsafe-swiftshader', '--hide-scrollbars'];
  return puppeteer.launch({ executablePath: chromium, args, headless: true });
}

/** @param {'dark' | 'light'} theme @param {boolean} phone 390 x 844 at twice the pixels, else 1600 x 1000 */
export async function open(browser, url, theme, phone = false) {
  const page = await browser.newPage();
  page.errors = [];
  page.on('pageerror', (error) => page.errors.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') page.errors.push(message.text()); });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }]);
  await page.setViewport(phone
    ? { width: 390, height: 844, deviceScaleFactor: 2, isMobile: true, hasTouch: true }
    : { width: 1600, height: 1000 });
  await page.goto(url);
  return page;
}

/** Waits until the page's own words for its map are one of these. */
export function until_map(page, ...worth) {
  return page.waitForFunction((wanted) => wanted.includes(document.body.dataset.map), { timeout: 30000, polling: 100 }, worth);
}
