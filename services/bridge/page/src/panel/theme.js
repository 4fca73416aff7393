/** Light, dark, or as the system has it; kept for the next visit. */
import { find } from './dom.js';

const NEXT = { auto: 'light', light: 'dark', dark: 'auto' };
const SIGNS = { auto: '◐', light: '☀', dark: '☾' };
const KEY = 'gvom-theme';

function stored() {
  try {
    return localStorage.getItem(KEY) ?? 'auto';
  } catch {
    return 'auto';  // a browser that keeps nothing
  }
}

function store(theme) {
  try {
    localStorage.setItem(KEY, theme);
  } catch { /* then it is forgotten */ }
}

/** @param {(theme: 'dark' | 'light') => void} on_change called at once, and whenever it changes */
export function start_theme(on_change) {
  const system = matchMedia('(prefers-color-scheme: dark)');
  let theme = stored() in NEXT ? stored() : 'auto';
  const apply = () => {
    const shown = theme !== 'auto' ? theme : system.matches ? 'dark' : 'light';
    document.documentElement.dataset.theme = shown;
    find('theme').textContent = SIGNS[theme];
    find('theme').title = `Colours: ${theme}`;
    on_change(shown);
  };
  system.addEventListener('change', apply);
  find('theme').addEventListener('click', () => {
    theme = NEXT[theme];
    store(theme);
    apply();
  });
  apply();
}
