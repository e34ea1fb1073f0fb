// SPDX-License-Identifier: GPL-2.0-or-later
// Tests that a page that is open for a shift keeps its memory: the status of a running machine is recorded,
// and replayed at 50 times its speed (J3). MW_SCREEN_REPLAY_H=3 gives the figure of docs/user/screen.md.
import { afterAll, beforeAll, expect, it } from 'vitest';
import type { CDPSession, Page } from 'playwright-core';
import { bringUp, errorsOf, Rig, sleep, untilText } from './rig';

const HOURS = Number(process.env['MW_SCREEN_REPLAY_H'] ?? 0.1);
const SPEED = 50;
const PARTS = HOURS < 1 ? 1 : 12;
const RECORD_MS = 8000;
const STATUS_HZ = 20;
const rig = new Rig();
let page: Page;
let session: CDPSession;

/** The page's socket records statuses and replays them with continuing time stamps. */
const RECORDER = `
const Real = window.WebSocket;
window.recorded = [];
window.isReplaying = false;
window.WebSocket = class extends Real {
  set onmessage(act) {
    window.hear = act;
    super.onmessage = (event) => {
      const isStatus = event.data.startsWith('{"status"');
      if (isStatus && window.isRecording) { window.recorded.push(event.data); }
      if (!isStatus || !window.isReplaying) { act(event); }
    };
  }
};
window.replay = (count, perTick) => new Promise((done) => {
  const all = window.recorded.map((one) => JSON.parse(one)).filter((one) => !one.full);
  window.isReplaying = true;
  let [played, time] = [0, 0];
  const timer = setInterval(() => {
    for (let i = 0; i < perTick && played < count; ++i, ++played) {
      const told = all[played % all.length];
      const now = told.status.time_ns;
      if (now !== undefined) { time = Math.max(time, now); }
      time += 50e6;
      window.hear({ data: JSON.stringify({ status: { ...told.status, time_ns: time, cycle: played } }) });
    }
    if (played >= count) { clearInterval(timer); window.isReplaying = false; done(played); }
  }, 20);
});
`;

interface Replayer {
  isRecording: boolean;
  recorded: string[];
  replay(count: number, perTick: number): Promise<number>;
}

async function heap(): Promise<number> {
  await session.send('HeapProfiler.collectGarbage');
  await sleep(200);
  await session.send('HeapProfiler.collectGarbage');
  const { usedSize } = await session.send('Runtime.getHeapUsage');
  return usedSize / 1e6;
}

async function play(statuses: number): Promise<void> {
  const perTick = (STATUS_HZ * SPEED) / 50;
  await page.evaluate(([count, each]) => (window as unknown as Replayer).replay(count, each), [statuses, perTick] as const);
}

beforeAll(async () => {
  rig.write('round.ngc', `G21 G90 G64 F3000\no1 repeat [1000]\n${Array.from({ length: 40 }, (_, i) => `G1 X${(30 * Math.cos(i / 6)).toFixed(3)} Y${(30 * Math.sin(i / 6)).toFixed(3)}`).join('\n')}\no1 endrepeat\nM2\n`);
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page({}, 'about:blank');
  await page.addInitScript(RECORDER);
  await page.goto(rig.address);
  session = await page.context().newCDPSession(page);
  await bringUp(page);
  await page.getByTestId('tab-programs').click();
  await page.getByTestId('open-round.ngc').click();
  await page.getByTestId('path-done').waitFor();
  await page.getByTestId('run').click();
  await untilText(page, 'run-state', 'Running');
  await page.evaluate(() => ((window as unknown as Replayer).isRecording = true));
  await sleep(RECORD_MS);
  await page.evaluate(() => ((window as unknown as Replayer).isRecording = false));
}, 60_000);

afterAll(async () => {
  await rig.end();
});

it('keeps its memory over a shift', async () => {
  const statuses = Math.round(HOURS * 3600 * STATUS_HZ);
  const warm = Math.max(2400, Math.round(statuses / 20)); // after a minute, the plots and the trail have their full size
  expect(await page.evaluate(() => (window as unknown as Replayer).recorded.length)).toBeGreaterThan(50);
  await play(warm);
  const before = await heap();
  let after = before;
  for (let part = 1; part <= PARTS; ++part) {
    const begin = Date.now();
    await play(Math.round(statuses / PARTS));
    const took = (Date.now() - begin) / 1000;
    after = await heap();
    console.log(`${((HOURS * part) / PARTS).toFixed(2)} of ${HOURS} h of status, this part in ${took.toFixed(0)} s: the page's heap ${before.toFixed(2)} MB before, ${after.toFixed(2)} MB now`);
  }
  expect(after - before).toBeLessThan(1);
  expect(errorsOf(page)).toEqual([]);
}, Math.max(120_000, HOURS * 3600 * 1000));
