/** npm run mock [PORT]: serves dist/ with a drive of two minutes: 40 s well, 15 s without the rear lidar, 6 s without fusion. */
import { fileURLToPath } from 'node:url';
import { MockBridge } from './server.js';

const bridge = new MockBridge(fileURLToPath(new URL('../dist', import.meta.url)));
const port = await bridge.listen(Number(process.argv[2] ?? 8765));
console.log(`http://127.0.0.1:${port}`);
setInterval(() => {
  const phase_s = bridge.time_s % 75;
  bridge.state.rear = !(phase_s > 40 && phase_s < 55);
  bridge.state.fusion = !(phase_s > 65 && phase_s < 71);
}, 200);
