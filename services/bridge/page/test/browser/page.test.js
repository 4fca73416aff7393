/** The built page in headless Chromium, against the mock of gvom-bridge. Times are long: a busy machine without a GPU is slow. */
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { MockBridge } from '../../mock/server.js';
import { chromium, launch, open, until_map } from './browser.js';

const dist = process.env.GVOM_PAGE ?? fileURLToPath(new URL('../../dist', import.meta.url));
const lacks = !chromium ? 'Chromium is not here' : !existsSync(`${dist}/index.html`) && 'the page is not built: npm run build';
const MAP_TOPICS = ['/gvom/layers', '/gvom/plan', '/gvom/trajectory', '/tf'];

const text = (page, selector) => page.$eval(selector, (node) => node.innerText);
const topics = (bridge) => [...bridge.clients].flatMap((client) => [...client.topics.keys()]).sort();

async function until(holds) {
  for (const end_ms = Date.now() + 60000; Date.now() < end_ms;) {
    if (await holds()) return;
    await new Promise((resolve) => { setTimeout(resolve, 50); });
  }
  assert.fail(`not in 60 s: ${holds}`);
}

test('the page in Chromium', { skip: lacks, timeout: 280000 }, async (t) => {
  const bridge = new MockBridge(dist, { start_s: 7, step_s: 0.2 });
  const port = await bridge.listen();
  const browser = await launch();
  t.after(async () => {
    await browser.close();
    bridge.close();
  });
  const page = await open(browser, `http://127.0.0.1:${port}`, 'dark', { width: 900, height: 500 });

  await t.test('shows a fresh map and what is well', async () => {
    await until_map(page, 'fresh');
    await until(async () => /All is well/.test(await text(page, '#health')));
    const drawn = await page.evaluate(() => window.gvom.scene.obstacles.count);
    assert.ok(drawn > 20, `${drawn} obstacles`);
    assert.deepEqual(page.errors, []);
  });

  await t.test('draws the relief: its colours are on the screen', async () => {
    const colours = await page.evaluate(() => {
      const { scene } = window.gvom;
      const gl = scene.renderer.getContext();
      scene.renderer.render(scene.three, scene.camera.camera);
      const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const seen = new Set();
      for (let i = 0; i < pixels.length; i += 64) seen.add((pixels[i] >> 4) << 8 | (pixels[i + 1] >> 4) << 4 | pixels[i + 2] >> 4);
      return seen.size;
    });
    assert.ok(colours > 40, `${colours} colours`);
  });

  await t.test('names a missing lidar', async () => {
    bridge.state.rear = false;
    await until(async () => /lidar rear missing/.test(await text(page, '#lidars')));
    await until(async () => /gvom-ingest-rear is degraded: no packets/.test(await text(page, '#health')));
    bridge.state.rear = true;
  });

  await t.test('greys out when no map comes, and says why', async () => {
    bridge.state.fusion = false;
    await until_map(page, 'silent');
    await until(async () => /gvom-fusion is failed: has said nothing/.test(await text(page, '#notice')));
    assert.match(await page.$eval('#scene', (node) => getComputedStyle(node).filter), /grayscale/);
    bridge.state.fusion = true;
    await until_map(page, 'fresh');
  });

  await t.test('looks back, and never calls that fresh', async () => {
    await page.$eval('#slider', (slider) => {
      slider.value = '-2';
      slider.dispatchEvent(new Event('input'));
    });
    await until_map(page, 'past');
    assert.match(await text(page, '#past'), /Looking back \d/);
    await page.$eval('#live', (button) => button.click());
    await until_map(page, 'fresh');
  });

  await t.test('a hidden tab takes the status only', async () => {
    const other = await browser.newPage();
    await until(() => topics(bridge).join() === '/gvom/status');
    await other.close();
    await page.bringToFront();
    await until(() => MAP_TOPICS.every((topic) => topics(bridge).includes(topic)));
    await until_map(page, 'fresh');
  });

  await t.test('a client that stands still costs the bridge no memory, and knows that what waited is old', async () => {
    const most_waiting = { now: 0 };
    const watch = setInterval(() => {
      for (const { waiting } of bridge.clients) most_waiting.now = Math.max(most_waiting.now, waiting.size);
    }, 20);
    const { before, after } = await page.evaluate(() => new Promise((resolve) => {
      const { feed } = window.gvom;
      const show = feed.on_map;
      const look = () => ({
        age_s: feed.age.age_s(performance.now() / 1000), stamp_s: feed.age.arrivals.at(-1).stamp_s, wall_s: Date.now() / 1000,
      });
      feed.on_map = () => {
        const before = look();
        feed.on_map = () => {
          feed.on_map = show;
          resolve({ before, after: look() });
        };
        for (const end_ms = performance.now() + 6000; performance.now() < end_ms;);
      };
    }));
    clearInterval(watch);
    // How far the page is behind all the time, on a machine that is too slow for it or that pauses, nobody tells it.
    const untold_s = ({ age_s, stamp_s, wall_s }) => wall_s - (stamp_s - 1000 + bridge.started_wall_s) - age_s;
    assert.ok(untold_s(after) < untold_s(before) + 3, `the first map after it is ${untold_s(after)} s older than it is said to be, the one before ${untold_s(before)} s`);
    assert.ok(most_waiting.now <= 6, `${most_waiting.now} messages waited`);
    await until_map(page, 'fresh');
  });

  await t.test('says that the bridge is gone, and comes back by itself', async () => {
    for (const { socket } of bridge.clients) socket.terminate();
    bridge.refuses = true;
    await until(async () => /No connection to 127.0.0.1/.test(await text(page, '#notice')));
    bridge.refuses = false;
    await until_map(page, 'fresh');
  });

  await t.test('without WebGL it says so, and goes on with the rest', async () => {
    const blind = await browser.newPage();
    await blind.evaluateOnNewDocument(() => {
      const get = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function context(kind, ...more) {
        return kind.startsWith('webgl') ? null : get.call(this, kind, ...more);
      };
    });
    await blind.goto(`http://127.0.0.1:${port}`);
    await until(async () => /has no WebGL 2/.test(await text(blind, '#notice')));
    await until(async () => /All is well/.test(await text(blind, '#health')));
    await blind.close();
  });
});
