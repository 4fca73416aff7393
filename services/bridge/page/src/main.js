/** The page: takes what the bridge sends, draws it, and says how old it is. */
import '@fontsource-variable/inter/wght.css';
import './style.css';
import { Feed, clock_s } from './feed.js';
import { show_age, show_notice } from './panel/age_readout.js';
import { find } from './panel/dom.js';
import { show_health, show_summary } from './panel/health.js';
import { make_key, show_layers, show_note, show_range } from './panel/legend.js';
import { Scrubber } from './panel/scrubber.js';
import { start_theme } from './panel/theme.js';
import { past_words, reason_of, title_of, worth_of } from './panel/words.js';
import { BlindScene } from './view/blind_scene.js';
import { Scene } from './view/scene.js';

const TICK_MS = 100;
const HEALTH_TICKS = 10;
const PHONE_PX = 820;
const BLIND = 'This browser has no WebGL 2: nothing is drawn.';
const COLOURS = {
  dark: { background: '#14181c', no_value: '#5b6066', plan: '#ffffff' },
  light: { background: '#e9eaec', no_value: '#9aa0a6', plan: '#14181c' },
};

/** Where the bridge is: this page's own server, or ?server=HOST:PORT. */
function bridge_url() {
  const server = new URLSearchParams(location.search).get('server') ?? location.host;
  return `${location.protocol === 'https:' ? 'wss' : 'ws'}://${server}`;
}

const shows = { obstacles: true, ways: true, voxels: false };
const is_phone = () => window.innerWidth < PHONE_PX;
const scene = make_scene();
const feed = new Feed(bridge_url(), { on_map: show_live, on_status: summarise });
const scrubber = new Scrubber(feed.history, show_at);
let layer = 'height';
let layers_offered = '';

function summarise() {
  show_summary(feed.status, feed.connection?.connected ? clock_s() - feed.status_at_s : Infinity);
}

function make_scene() {
  try {
    return new Scene(find('scene'));
  } catch (error) {
    console.warn(`gvom: nothing can be drawn: ${error.message}`);
    return new BlindScene();
  }
}

/** Obstacles have their height from the voxels; on a phone those come only when they are asked for. */
function choose_topics() {
  feed.set_wanted(document.hidden, shows.voxels || (shows.obstacles && !is_phone()));
}

function show_live() {
  if (scrubber.time_s === null) scene.show(feed.view());
  const offered = feed.map.names.join();
  if (offered === layers_offered) return;
  layers_offered = offered;
  show_layers(feed.map.names, layer);
}

function show_at(time_s) {
  const entry = time_s === null ? null : feed.history.at(time_s);
  const view = entry ? entry.value.view : feed.map && feed.view();
  if (view) scene.show(view);
}

function tick_age(now_s) {
  const age_s = feed.age.age_s(now_s);
  const worth = worth_of(age_s, feed.age.silent_s(now_s));
  if (scrubber.time_s !== null) {
    show_age('past', now_s - scrubber.time_s, 0);
    show_notice('', '');
    find('past').hidden = false;
    find('past').textContent = past_words(now_s - scrubber.time_s, feed.history.at(scrubber.time_s).value.missing, worth);
    return;
  }
  find('past').hidden = true;
  show_age(worth, age_s, feed.age.rate_hz(now_s));
  if (worth === 'fresh' && scene.is_blind) show_notice('No map can be drawn', `${BLIND} Ages and health are as they are.`);
  else if (worth === 'fresh') show_notice('', '');
  else show_notice(title_of(worth, age_s), `${reason_of(feed.circumstances(now_s))}${scene.is_blind ? ` ${BLIND}` : ''}`);
}

let ticks = 0;
function tick() {
  const now_s = clock_s();
  tick_age(now_s);
  scrubber.update(now_s);
  feed.connection.watch();
  if (ticks++ % HEALTH_TICKS) return;
  show_health(feed.status, now_s - feed.status_at_s);
  summarise();
  show_range(layer, scene.ground.range);
  show_note(Boolean(scene.view?.tops), scene.voxels.mesh.visible ? scene.voxels.left_out : null);
}

let drawn_ms = performance.now();
function draw(now_ms) {
  scene.draw(Math.min(0.1, (now_ms - drawn_ms) / 1000), now_ms);
  drawn_ms = now_ms;
  requestAnimationFrame(draw);
}

function choose_camera(mode) {
  scene.camera.set_mode(mode);
  for (const button of find('cameras').children) button.setAttribute('aria-pressed', String(button.dataset.mode === mode));
}

/** A button that opens and closes something, on a phone. */
function make_opener(button, open_class) {
  find(button).addEventListener('click', ({ currentTarget }) => {
    currentTarget.setAttribute('aria-expanded', String(document.body.classList.toggle(open_class)));
  });
}

function start() {
  start_theme((theme) => scene.set_colours(COLOURS[theme]));
  make_key(shows, (what, is_shown) => {
    shows[what] = is_shown;
    scene.set_shown(what, is_shown);
    choose_topics();
  });
  find('layer').addEventListener('change', ({ target }) => {
    layer = target.value;
    scene.set_layer(layer);
    show_range(layer, scene.ground.range);
  });
  for (const button of find('cameras').children) button.addEventListener('click', () => choose_camera(button.dataset.mode));
  choose_camera('follow');
  make_opener('open-health', 'health-open');
  make_opener('open-key', 'key-open');
  document.addEventListener('visibilitychange', choose_topics);
  new ResizeObserver(([{ contentRect }]) => scene.resize(contentRect.width, contentRect.height)).observe(find('scene'));
  summarise();
  choose_topics();
  setInterval(tick, TICK_MS);
  requestAnimationFrame(draw);
}

start();
window.gvom = { feed, scene };  // for the tests, and for who is curious
