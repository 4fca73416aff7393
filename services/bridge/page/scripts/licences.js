/** Prints the licences of what is in the bundle. */
import { readFileSync } from 'node:fs';

const BUNDLED = { three: 'three.js', '@fontsource-variable/inter': 'the typeface Inter, by Fontsource' };

console.log('The page holds, besides gvom (Apache-2.0):');
for (const [name, title] of Object.entries(BUNDLED)) {
  const folder = `node_modules/${name}`;
  const { version, license } = JSON.parse(readFileSync(`${folder}/package.json`, 'utf8'));
  console.log(`\n${'-'.repeat(80)}\n${title}, ${version} (${license})\n\n${readFileSync(`${folder}/LICENSE`, 'utf8')}`);
}
