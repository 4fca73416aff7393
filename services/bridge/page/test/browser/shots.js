/** npm run shots [FOLDER]: pictures of the page in all its states, to be looked at. */
import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { MockBridge } from '../../mock/server.js';
import { DESKTOP, PHONE, launch, open, until_map } from './browser.js';

const folder = process.argv[2] ?? fileURLToPath(new URL('../../shots', import.meta.url));
const only = process.argv[3];
mkdirSync(folder, { recursive: true });
const bridge = new MockBridge(fileURLToPath(new URL('../../dist', import.meta.url)), { start_s: 7, step_s: 0.25 });
const url = `http://127.0.0.1:${await bridge.listen()}`;
const browser = await launch();

const pause = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

/** In the page: no picture until draw_finely(), so that a processor that draws has time for the messages. */
function draw_not() {
  window.gvom.scene.pace.is_ready = () => false;
}

function draw_finely() {
  const { scene } = window.gvom;
  scene.renderer.setPixelRatio(devicePixelRatio);
  scene.renderer.render(scene.three, scene.camera.camera);
}

async function shot(name, theme, size, act = async () => {}, worth = ['fresh']) {
  if (only && !new RegExp(only).test(name)) return;
  const page = await open(browser, url, theme, size);
  await until_map(page, 'fresh', 'stale');
  await page.evaluate(draw_not);
  await pause(4000);
  await act(page);
  await page.evaluate(draw_finely);
  await until_map(page, ...worth).catch(() => console.log(`${name}: not ${worth}`));
  await pause(400);
  await page.screenshot({ path: `${folder}/${name}.png` });
  console.log(name, await page.$eval('#age', (node) => node.innerText.replace('\n', ' ')), page.errors);
  await page.close();
}

const choose = (layer) => async (page) => { await page.select('#layer', layer); await pause(600); };
const press = (selector, ms = 900) => async (page) => { await page.$eval(selector, (node) => node.click()); await pause(ms); };

await shot('desktop-dark', 'dark', DESKTOP);
await shot('desktop-light', 'light', DESKTOP);
await shot('desktop-slope', 'dark', DESKTOP, choose('slope'));
await shot('desktop-cost-light', 'light', DESKTOP, choose('cost'));
await shot('desktop-visibility', 'dark', DESKTOP, choose('visibility'));
await shot('desktop-top', 'dark', DESKTOP, press('[data-mode=top]', 1500));
await shot('desktop-voxels', 'dark', DESKTOP, press('#key .switch:nth-child(3) input', 1800));
await shot('desktop-past', 'dark', DESKTOP, async (page) => {
  await page.$eval('#slider', (slider) => { slider.value = '-2.5'; slider.dispatchEvent(new Event('input')); });
  await pause(500);
}, ['past']);
await shot('desktop-missing', 'dark', DESKTOP, async () => { bridge.state.rear = false; await pause(3000); });
bridge.state.rear = true;
await shot('desktop-silent', 'dark', DESKTOP, async () => { bridge.state.fusion = false; await pause(3000); }, ['silent']);
bridge.state.fusion = true;
await pause(1000);
await shot('phone-light', 'light', PHONE);
await shot('phone-dark', 'dark', PHONE);
await shot('phone-health', 'light', PHONE, async (page) => { bridge.state.rear = false; await pause(1500); await press('#open-health')(page); });
await shot('phone-silent', 'light', PHONE, async () => { bridge.state.fusion = false; await pause(2500); }, ['silent']);
bridge.state.fusion = true;
bridge.state.rear = true;
await browser.close();
bridge.close();
process.exit(0);
