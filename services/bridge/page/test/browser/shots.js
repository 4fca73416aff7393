/** npm run shots [FOLDER]: pictures of the page in all its states, to be looked at. */
import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { MockBridge } from '../../mock/server.js';
import { launch, open, until_map } from './browser.js';

const folder = process.argv[2] ?? fileURLToPath(new URL('../../shots', import.meta.url));
const only = process.argv[3];
mkdirSync(folder, { recursive: true });
const bridge = new MockBridge(fileURLToPath(new URL('../../dist', import.meta.url)), { start_s: 7, step_s: 0.25 });
const url = `http://127.0.0.1:${await bridge.listen()}`;
const browser = await launch();

const pause = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

async function shot(name, theme, phone, act = async () => {}) {
  if (only && !name.includes(only)) return;
  const page = await open(browser, url, theme, phone);
  await until_map(page, 'fresh', 'stale');
  await pause(5000);
  await act(page);
  await page.evaluate(() => { gvom.scene.pace.pixels = devicePixelRatio; gvom.scene.renderer.setPixelRatio(devicePixelRatio); gvom.scene.dirty = true; });
  await pause(1200);
  await page.screenshot({ path: `${folder}/${name}.png` });
  console.log(name, await page.$eval('#age', (node) => node.innerText.replace('\n', ' ')), page.errors);
  await page.close();
}

async function without(what, act) {
  bridge.state[what] = what === 'silent';
  await act();
  bridge.state[what] = what !== 'silent';
  await pause(1200);
}

const choose = (layer) => async (page) => { await page.select('#layer', layer); await pause(600); };
const press = (selector, ms = 900) => async (page) => { await page.$eval(selector, (node) => node.click()); await pause(ms); };

await shot('desktop-dark', 'dark', false);
await shot('desktop-light', 'light', false);
await shot('desktop-slope', 'dark', false, choose('slope'));
await shot('desktop-cost-light', 'light', false, choose('cost'));
await shot('desktop-visibility', 'dark', false, choose('visibility'));
await shot('desktop-top', 'dark', false, press('[data-mode=top]', 1500));
await shot('desktop-voxels', 'dark', false, press('#key .switch:nth-child(3) input', 1800));
await shot('desktop-past', 'dark', false, async (page) => {
  await page.$eval('#slider', (slider) => { slider.value = '-2.5'; slider.dispatchEvent(new Event('input')); });
  await pause(500);
});
await shot('desktop-missing', 'dark', false, async () => { bridge.state.rear = false; await pause(3000); });
bridge.state.rear = true;
await shot('desktop-stale', 'light', false, () => without('fusion', () => pause(2600)).then(() => {}));
await shot('desktop-silent', 'dark', false, async () => { bridge.state.fusion = false; await pause(3000); });
bridge.state.fusion = true;
await pause(1000);
await shot('phone-light', 'light', true);
await shot('phone-dark', 'dark', true);
await shot('phone-health', 'light', true, async (page) => { bridge.state.rear = false; await pause(1500); await press('#open-health')(page); });
await shot('phone-silent', 'light', true, async () => { bridge.state.fusion = false; await pause(2500); });
bridge.state.fusion = true;
bridge.state.rear = true;
await browser.close();
bridge.close();
process.exit(0);
