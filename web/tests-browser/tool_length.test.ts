// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the active tool length and its effect on a touch off, a spindle without an encoder, and a machine without a probe.
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { bringUp, errorsOf, judgeByAxe, Rig, showFailure, sleep, text, until, untilText } from './rig';

const rig = new Rig((ini) => ini.replace('HALFILE = spindle_sim.hal\n', ''));
let page: Page;

async function tab(id: string): Promise<void> {
  await page.getByTestId(`tab-${id}`).click();
}
async function mdi(line: string): Promise<void> {
  await page.getByTestId('mdi-line').fill(line);
  await page.getByTestId('mdi-send').click();
}
async function load(tool: number): Promise<void> {
  await tab('tools');
  await page.getByTestId(`load-${tool}`).click();
  await untilText(page, 'tool', `T${tool}`);
  await untilText(page, 'run-state', 'Idle');
}

beforeAll(async () => {
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

describe('a load from the tool table', () => {
  it('leaves G49, and the screen shows that no length is active', async () => {
    await untilText(page, 'length', 'Length: none');
    await load(1);
    await untilText(page, 'length', /Length: none.*T1 is in the spindle/s);
    await sleep(500);
    expect(await text(page, 'length')).toMatch(/Length: none/);
  });

  it('applies the length of the new tool where one is active', async () => {
    await mdi('G43');
    await untilText(page, 'length', 'Length: T1');
    await load(2);
    await untilText(page, 'length', 'Length: T2');
    expect(rig.pin('motion.tooloffset.z')).toBe('35');
  });
});

describe('a touch off with the length of another tool', () => {
  const zero = async (): Promise<string> => {
    await tab('offsets');
    return text(page, 'g5x-Z');
  };
  /** The status with the effect may arrive after the outcome of a command. */
  const untilZero = (wanted: () => number): Promise<void> => until(async () => Math.abs(Number(await zero()) - wanted()) < 0.0005, 'the zero of Z');

  it('is warned of', async () => {
    await mdi('G43 H1');
    await untilText(page, 'length', /Length: T1.*T2 is in the spindle/s);
    await page.getByTestId('length').click();
    await untilText(page, 'length-dialog', /T2 is in the spindle. The length of T1 is active.*Positions of Z/s);
    await judgeByAxe(page, 'tool length');
    await page.getByTestId('length-dialog').getByText('Close').click();
  });

  it('sets nothing before the operator has chosen', async () => {
    const before = await zero();
    await page.getByTestId('touch-Z').click();
    await untilText(page, 'length-choice', /T2 is in the spindle. The length of T1 is active.*wrong for Z/s);
    await page.getByTestId('touch-off-value').fill('5');
    await page.getByTestId('touch-off-value').press('Enter');
    await sleep(400);
    expect(await page.getByTestId('touch-off-set').count()).toBe(0);
    await page.getByTestId('touch-off').getByText('Close').click();
    expect(await zero()).toBe(before);
  });

  it('applies G43 first when that is chosen', async () => {
    await page.getByTestId('touch-Z').click();
    await page.getByTestId('touch-off-value').fill('5');
    await page.getByTestId('length-apply').click();
    await page.getByTestId('touch-off').waitFor({ state: 'detached' });
    await untilText(page, 'length', 'Length: T2');
    await untilText(page, 'work-Z', '5.000');
    await untilZero(() => rig.position(2) - 35 - 5);
  });

  it('keeps the active length when that is chosen', async () => {
    await mdi('G49');
    await page.getByTestId('touch-Z').click();
    await page.getByTestId('touch-off-value').fill('5');
    await page.getByTestId('length-keep').click();
    await page.getByTestId('touch-off').waitFor({ state: 'detached' });
    await untilZero(() => rig.position(2) - 5);
  });

  it('asks nothing for an axis without a length', async () => {
    await page.getByTestId('touch-X').click();
    expect(await page.getByTestId('length-choice').count()).toBe(0);
    await page.getByTestId('touch-off-set').waitFor();
    await page.getByTestId('touch-off').getByText('Close').click();
  });
});

describe('a spindle without an encoder', () => {
  it('shows the commanded speed as commanded, and nothing as measured', async () => {
    await page.getByTestId('spindle-set-0').fill('1000');
    await page.getByTestId('spindle-forward-0').click();
    await untilText(page, 'spindle-state-0', /Forward\s+1000, commanded/);
    await untilText(page, 'spindle-speed', /^1000/);
    expect(await text(page, 'spindle-speed-of')).toBe('Spindle, commanded');
    await page.getByTestId('spindle-stop-0').click();
    await untilText(page, 'spindle-speed', /^0/);
  });
});

describe('a machine without a probe', () => {
  it('moves nothing for a probing cycle, and says why', async () => {
    await tab('probing');
    await untilText(page, 'probe-contact', 'not connected');
    await untilText(page, 'probe-hint', /No probe is connected.*motion\.probe-input/);
    const before = rig.position(0);
    await page.getByTestId('find-X+').click({ force: true });
    await untilText(page, 'why', /No probe is connected/);
    await page.getByTestId('probe-in-spindle').click();
    await sleep(400);
    expect(rig.position(0)).toBe(before);
    await until(async () => (await text(page, 'run-state')) === 'Idle', 'rest');
    expect(errorsOf(page)).toEqual([]);
  });
});
