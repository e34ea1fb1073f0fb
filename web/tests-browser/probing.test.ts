// SPDX-License-Identifier: GPL-2.0-or-later
// Tests probing in the view: a switch closes at a face at X 12 of the machine, for a probe ball of 4 mm (I1,
// J1).
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { bringUp, errorsOf, Rig, showFailure, sleep, text, until, untilText } from './rig';

const TOUCH_MM = 12 - 4 / 2;
const rig = new Rig((ini) => ini.replace('HALFILE = spindle_sim.hal\n', 'HALFILE = spindle_sim.hal\nHALFILE = probe.hal\n'));
let page: Page;

beforeAll(async () => {
  writeFileSync(
    join(rig.ini, '../probe.hal'),
    `loadrt wcomp names=wall\nloadrt or2 names=touched\naddf wall servo-thread\naddf touched servo-thread\nsetp wall.min ${TOUCH_MM}\nsetp wall.max 1000
net place joint.0.pos-fb => wall.in\nnet wall wall.out => touched.in0\nnet touch touched.out => motion.probe-input\n`,
  );
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

/** Touches the tip of the probe, or the setter, when the view asks for it. An earlier contact is not accepted. */
async function touchByHand(): Promise<void> {
  await untilText(page, 'probe-hint', /touch its tip by hand|Press the setter/);
  await untilText(page, 'run-state', 'Idle');
  await untilText(page, 'probe-contact', 'open');
  rig.setPin('touched.in1', '1');
  await untilText(page, 'probe-contact', 'contact');
  await untilText(page, 'probe-seen', 'contact detected');
  rig.setPin('touched.in1', '0');
  await untilText(page, 'probe-contact', 'open');
}
const isGated = async (id = 'find-X+'): Promise<boolean> => (await page.getByTestId(id).getAttribute('aria-disabled')) === 'true';

it('is gated until all is homed and the contact was seen', async () => {
  await page.getByTestId('tab-probing').click();
  expect(await isGated()).toBe(true);
  await bringUp(page);
  await untilText(page, 'probe-hint', /touch its tip by hand/);
  const before = rig.position(0);
  await page.getByTestId('find-X+').click({ force: true });
  await untilText(page, 'why', /touch its tip by hand/);
  await sleep(400);
  expect(rig.position(0)).toBe(before);
  await touchByHand();
  expect(await isGated()).toBe(false);
});

it('requires a check of the probe after a tool change and after the spindle has turned', async () => {
  await page.getByTestId('mdi-line').fill('T3 M6');
  await page.getByTestId('mdi-send').click();
  await untilText(page, 'probe-in-spindle', /T3 drill/);
  await untilText(page, 'probe-seen', 'no contact yet');
  expect(await isGated()).toBe(true);
  await touchByHand();
  expect(await isGated()).toBe(false);
  await page.getByTestId('spindle-set-0').fill('500');
  await page.getByTestId('spindle-forward-0').click();
  await untilText(page, 'probe-hint', /spindle is turning/);
  await page.getByTestId('spindle-stop-0').click();
  await untilText(page, 'probe-seen', 'no contact yet');
  await touchByHand();
});

it('takes the contact of the setter for a tool length alone', async () => {
  await page.getByTestId('mdi-line').fill('T1 M6');
  await page.getByTestId('mdi-send').click();
  await untilText(page, 'probe-in-spindle', /T1/);
  await page.getByTestId('probe-tool').click();
  await untilText(page, 'probe-hint', /Press the setter/);
  await touchByHand();
  expect(await isGated('find')).toBe(false);
  await page.getByTestId('probe-edge').click();
  await untilText(page, 'probe-hint', /touch its tip by hand/);
  expect(await isGated()).toBe(true);
  await touchByHand();
});

it('asks with which tool length a zero of Z is set', async () => {
  await page.getByTestId('probe-system').selectOption('G54');
  await page.getByTestId('find-Z-').click();
  await untilText(page, 'length-choice', /T1 is in the spindle. No tool length is active.*wrong for Z/s);
  await page.getByTestId('probe-length').getByText('Close').click();
  await page.getByTestId('probe-system').selectOption({ index: 0 });
});

it('finds an edge, reports its position, and sets the zero there', async () => {
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

it('reports a missing edge, and returns to the start position', async () => {
  const before = rig.position(1);
  await page.getByTestId('find-Y+').click();
  await untilText(page, 'probe-result', /nothing is there within 20/, 20_000);
  await untilText(page, 'run-state', 'Idle');
  expect(rig.position(1)).toBeCloseTo(before, 6);
});

it('rejects values that are not numbers or not valid', async () => {
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
