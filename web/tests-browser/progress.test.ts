// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the time of a program, its remaining time, and the positions where time is lost (J3).
import { afterAll, beforeAll, expect, it } from 'vitest';
import type { Page } from 'playwright-core';
import { bringUp, errorsOf, judgeByAxe, Rig, text, until, untilText } from './rig';

const rig = new Rig();
let page: Page;

beforeAll(async () => {
  // 12 s at the programmed feed; the corners of the zigzag and the small circle take longer.
  const zigzag = Array.from({ length: 20 }, (_, i) => `X${10 + (i % 2)} Y${i * 0.5}`).join('\n');
  rig.write('part.ngc', `G21 G90 G61 F1200\nG1 X100\nX0\n${zigzag}\nG2 X12 I0.5 F20000\nG1 X60 F600\nM2\n`);
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
  await page.getByTestId('tab-programs').click();
  await page.getByTestId('open-part.ngc').click();
  await page.getByTestId('path-done').waitFor();
}, 60_000);

afterAll(async () => {
  await rig.end();
});

function seconds(shown: string): number {
  const [, min, s] = /(\d+):(\d\d)/.exec(shown) ?? [];
  return Number(min) * 60 + Number(s);
}

it('is calculated when the program is opened, and again at another override', async () => {
  await untilText(page, 'path-time', /≈ 0:\d\d/);
  const whole = seconds(await text(page, 'path-time'));
  expect(whole).toBeGreaterThan(14);
  expect(whole).toBeLessThan(22);
  await page.getByTestId('tab-process').click();
  await page.getByTestId('feed-override').fill('50');
  await untilText(page, 'feed-override-value', /50/);
  await page.getByTestId('tab-path').click();
  await until(async () => (await page.getByTestId('path-time').isVisible()) && seconds(await text(page, 'path-time')) > 1.7 * whole, 'twice the time');
  expect(seconds(await text(page, 'path-time'))).toBeLessThan(2.05 * whole);
  await page.getByTestId('step-feed-100').click();
  await until(async () => (await page.getByTestId('path-time').isVisible()) && seconds(await text(page, 'path-time')) === whole, 'the time of before');
  expect(errorsOf(page)).toEqual([]);
});

it('shows where time is lost and why, and jumps there', async () => {
  await page.getByTestId('tab-text').click();
  await page.getByTestId('slow-places').locator('summary').click();
  const worst = await text(page, 'slow-0');
  expect(worst).toMatch(/^Line \d+: \d+\.\d\d s, (acceleration|curvature: acceleration|velocity) of [XYZ[]/);
  await judgeByAxe(page, 'slow places');
  await page.getByTestId('slow-0').click();
  const line = Number(/Line (\d+)/.exec(worst)?.[1]);
  await untilText(page, 'run-from-line', new RegExp(`\\b${line}\\b`));
});

it('counts down to the end', async () => {
  await page.getByTestId('run').click();
  await until(async () => page.getByTestId('time-left').isVisible(), 'the time left');
  await untilText(page, 'time-left', /≈ 0:\d\d left/);
  const left = seconds(await text(page, 'time-left'));
  const begin = Date.now();
  await untilText(page, 'run-state', 'Idle', 60_000);
  const took = (Date.now() - begin) / 1000;
  expect(Math.abs(took - left)).toBeLessThan(2.5);
  expect(await page.getByTestId('time-left').isVisible()).toBe(false);
}, 90_000);

it('colours the path by the speed reached', async () => {
  await page.getByTestId('tab-path').click();
  await page.getByTestId('color-by').selectOption('speed');
  await untilText(page, 'legend', /Planned speed \d+.*mm\/min/);
  const legend = await text(page, 'legend');
  const top = Number(/(\d+) mm\/min$/.exec(legend)?.[1]);
  expect(top).toBeGreaterThanOrEqual(1200);
  expect(top).toBeLessThan(20_000); // the small circle does not reach the feed
  expect(errorsOf(page)).toEqual([]);
});
