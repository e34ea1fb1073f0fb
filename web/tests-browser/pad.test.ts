// SPDX-License-Identifier: GPL-2.0-or-later
// Tests jogs with a simulated gamepad.
import { afterAll, beforeAll, expect, it } from 'vitest';
import type { Page } from 'playwright-core';
import { bringUp, errorsOf, Rig, sleep, text, until, untilText } from './rig';

const rig = new Rig();
let page: Page;

/** Replaces navigator.getGamepads: `window.pad` is its result, `window.polls` the number of calls. */
const FAKED = `window.pad = null;
window.polls = 0;
navigator.getGamepads = () => (++window.polls, [window.pad === null ? null : { index: 0, id: 'faked', connected: true, mapping: 'standard', timestamp: performance.now(),
  axes: window.pad.axes, buttons: Array.from({ length: 17 }, (_, i) => ({ pressed: window.pad.hold && i === 4, value: 0, touched: false })) }]);`;

interface Faked {
  pad: { hold: boolean; axes: readonly number[] } | null;
  polls: number;
}

/** Returns the number of polls before. */
async function put(hold: boolean, axes: number[]): Promise<number> {
  return page.evaluate(([held, all]) => {
    const faked = window as unknown as Faked;
    faked.pad = { hold: held, axes: all };
    return faked.polls;
  }, [hold, axes] as const);
}
const POLLS = 4;
/** Waits until the page has polled several times, so that a delayed motion is detected. */
async function set(hold: boolean, axes: number[]): Promise<void> {
  const before = await put(hold, axes);
  await until(() => page.evaluate((polls) => (window as unknown as Faked).polls >= polls, before + POLLS), 'polls');
}
async function unplug(): Promise<void> {
  await page.evaluate(() => {
    (window as unknown as Faked).pad = null;
  });
}
async function isStopped(): Promise<boolean> {
  const [x, y] = [rig.position(0), rig.position(1)];
  await sleep(150);
  return x === rig.position(0) && y === rig.position(1);
}

beforeAll(async () => {
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await page.evaluate(FAKED);
  await bringUp(page);
  await set(false, [0, 0, 0, 0]);
  await page.getByTestId('pad-on').check();
}, 60_000);

afterAll(async () => {
  await rig.end();
});

it('moves while button and stick are held, and stops when either is released', async () => {
  await set(false, [1, 0, 0, 0]);
  expect(await isStopped()).toBe(true);
  await set(false, [0, 0, 0, 0]);
  await set(true, [0, 0, 0, 0]);
  await set(true, [0.9, 0, 0, 0]);
  await until(() => rig.position(0) > 3, 'X moves');
  await set(true, [0.1, 0, 0, 0]);
  await until(isStopped, 'the stop of X');
  const x = rig.position(0);
  await set(true, [0, 0.9, 0, 0]);
  await until(() => rig.position(1) < -3, 'a stick towards the operator moves Y back');
  await set(false, [0, 0.9, 0, 0]);
  await until(isStopped, 'the stop of X');
  expect(rig.position(0)).toBe(x);
}, 60_000);

it('moves slower with less', async () => {
  await set(false, [0, 0, 0, 0]);
  await set(true, [0, 0, 0, 0]);
  await set(true, [0, -0.4, 0, 0]);
  await untilText(page, 'velocity', /^7\d\d\b/); // a quarter of the stick's travel, at 3000 mm/min
  await set(true, [0, -0.6, 0, 0]);
  await untilText(page, 'velocity', /^15\d\d\b/);
  await set(false, [0, 0, 0, 0]);
  await until(isStopped, 'the stop of X');
}, 60_000);

it('ends when the pad is gone, or the window loses the attention, and begins by itself no more', async () => {
  for (const end of [unplug, () => page.evaluate(() => window.dispatchEvent(new Event('blur')))]) {
    await set(false, [0, 0, 0, 0]);
    await set(true, [0, 0, 0, 0]);
    const before = rig.position(0);
    await set(true, [-0.9, 0, 0, 0]);
    await until(() => rig.position(0) < before - 2, 'X moves');
    await end();
    await until(isStopped, 'the stop of X');
    await set(true, [-0.9, 0, 0, 0]);
    expect(await isStopped()).toBe(true);
  }
}, 60_000);

it('does nothing in another view, nor when it is switched off', async () => {
  await set(false, [0, 0, 0, 0]);
  await page.getByTestId('pad-on').uncheck();
  await set(true, [0, 0, 0, 0]);
  await set(true, [0.9, 0, 0, 0]);
  expect(await isStopped()).toBe(true);
  await page.getByTestId('pad-on').check();
  expect(await isStopped()).toBe(true); // the stick was not released
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByTestId('tab-path').click();
  for (const [hold, x] of [[false, 0], [true, 0], [true, 0.9]] as const) {
    await put(hold, [x, 0, 0, 0]);
    await sleep(80); // the page does not poll in this view
  }
  expect(await isStopped()).toBe(true);
  expect(await text(page, 'run-state')).toBe('Idle');
  expect(errorsOf(page)).toEqual([]);
}, 60_000);
