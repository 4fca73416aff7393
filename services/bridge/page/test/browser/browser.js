/** A headless Chromium over CDP, as the tests need it. */
import puppeteer from 'puppeteer-core';
import { existsSync } from 'node:fs';

const PLACES = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
export const chromium = PLACES.find((place) => place && existsSync(place));

export function launch() {
  const args = ['--no-sandbox', '--disable-dev-shm-usage', '--enable-unsafe-swiftshader', '--hide-scrollbars'];
  return puppeteer.launch({ executablePath: chromium, args, headless: true });
}

export const DESKTOP = { width: 1600, height: 1000 };
export const PHONE = { width: 390, height: 844, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

/** @param {'dark' | 'light'} theme @param {object} size of the window, as puppeteer's setViewport() takes it */
export async function open(browser, url, theme, size) {
  const page = await browser.newPage();
  page.errors = [];
  page.on('pageerror', (error) => page.errors.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') page.errors.push(message.text()); });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }]);
  await page.setViewport(size);
  await page.goto(url);
  return page;
}

/** Waits until the page's own words for its map are one of these. */
export function until_map(page, ...worth) {
  return page.waitForFunction((wanted) => wanted.includes(document.body.dataset.map), { timeout: 60000, polling: 100 }, worth);
}
