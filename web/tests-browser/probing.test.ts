// SPDX-License-Identifier: GPL-2.0-or-later
// Probing by the view: a switch that closes where a face stands at X 12 of the machine, seen by a ball of 4 mm (I1, J1).
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { bringUp, errorsOf, Rig, showFailure, text, until, untilText } from './rig';

const TOUCH_MM = 12 - 4 / 2;
const rig = new Rig((ini) => ini.replace('HALFILE = spindle_sim.hal\n', 'HALFILE = spindle_sim.hal\nHALFILE = probe.hal\n'));
let page: Page;

beforeAll(async () => {
  writeFileSync(
    join(rig.ini, '../probe.hal'),
    `loadrt wcomp names=wall\naddf wall servo-thread\nsetp wall.min ${TOUCH_MM}\nsetp wall.max 1000\nnet place joint.0.pos-fb => wall.in\nnet touch wall.out => motion.probe-input\n`,
  );
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

it('is gated until all is homed', async () => {
  await page.getByTestId('tab-probing').click();
  expect(await page.getByTestId('find-X+').getAttribute('aria-disabled')).toBe('true');
  await bringUp(page);
  expect(await page.getByTestId('find-X+').getAttribute('aria-disabled')).toBe('false');
});

it('finds a face, tells where it is, and sets the zero there', async () => {
  await page.getByTestId('probe-travel').fill('20');
  await page.getByTestId('probe-fast').fill('600');
  await page.getByTestId('probe-system').selectOption('G54');
  const before = rig.position(0);
  await page.getByTestId('find-X+').click();
  await untilText(page, 'probe-result', /face at X(12\.00|11\.99[89])/, 20_000);
  await untilText(page, 'run-state', 'Idle');
  expect(rig.position(0)).toBeCloseTo(before, 6);
  await until(async () => Math.abs(Number(await text(page, 'work-X')) - (before - 12)) < 0.004, 'the zero at the face');
});

it('tells what is not there, and is back where it began', async () => {
  const before = rig.position(1);
  await page.getByTestId('find-Y+').click();
  await untilText(page, 'probe-result', /nothing is there within 20/, 20_000);
  await untilText(page, 'run-state', 'Idle');
  expect(rig.position(1)).toBeCloseTo(before, 6);
});

it('refuses what is no number, and what cannot be', async () => {
  await page.getByTestId('probe-tip').fill('4.5.6');
  expect(await page.getByTestId('find-X+').getAttribute('aria-disabled')).toBe('true');
  await page.getByTestId('probe-tip').fill('4');
  await page.getByTestId('probe-travel').fill('500');
  const before = rig.position(0);
  await page.getByTestId('find-X+').click();
  await untilText(page, 'probe-result', /the travel is 500.*at most/, 20_000);
  expect(rig.position(0)).toBe(before);
  expect(errorsOf(page)).toEqual([]);
});
