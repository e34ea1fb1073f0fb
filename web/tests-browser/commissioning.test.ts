// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the commissioning steps, from the wizard to "ready", using only the page (A7).
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { errorsOf, freePort, judgeByAxe, Rig, showFailure, sleep, until, untilText } from './rig';

const rig = new Rig();
const home = join(rig.folder, 'home');
const folder = join(home, 'millwright/configs/small_lathe');
let page: Page;

interface Shown {
  ask: string;
  number: string;
  text: string;
}
/** The request shown on the page; null if there is none. */
async function shown(): Promise<Shown | null> {
  return page.evaluate(() => {
    const prompt = document.querySelector<HTMLElement>('[data-testid=prompt]');
    const text = prompt?.querySelector('[data-testid=prompt-text]')?.textContent ?? '';
    return prompt === null ? null : { ask: prompt.dataset['ask'] ?? '', number: prompt.dataset['number'] ?? '', text };
  });
}
async function isNew(number: string): Promise<boolean> {
  return (await shown())?.number !== number;
}
async function pressHold(): Promise<void> {
  await page.getByTestId('steps-hold').hover();
  await page.mouse.down();
}

/** Fulfils one request of the page. @param factor ratio of measured to commanded travel */
let commanded = 0;
async function answer(asked: Shown, factor: number): Promise<void> {
  commanded = Number(/moves by ([\d.]+) /.exec(asked.text)?.[1] ?? commanded);
  if (asked.ask === 'confirm') {
    await page.getByTestId('steps-confirm').click();
  } else if (asked.ask === 'hold') {
    await pressHold();
    await until(() => isNew(asked.number), asked.text, 40_000);
    await page.mouse.up();
    return;
  } else if (asked.ask === 'choice') {
    await page.getByTestId('steps-choice-positive').click();
  } else if (asked.ask === 'number') {
    await page.getByTestId('steps-number').fill(asked.text.includes('indicator') ? '0' : asked.text.includes('tachometer') ? '6000' : String(commanded * factor).replace('.', ','));
    await page.getByTestId('steps-measure').click();
  }
  await until(() => isNew(asked.number), asked.text, 20_000);
}
/** Fulfils requests of the page until one satisfies `stop`. */
async function follow(stop: (asked: Shown) => boolean, factor = 1): Promise<Shown> {
  const end = Date.now() + 120_000;
  while (Date.now() < end) {
    const asked = await shown();
    if (asked !== null && stop(asked)) {
      return asked;
    }
    if (asked !== null && asked.ask !== 'wait' && asked.ask !== 'do') {
      await answer(asked, factor);
    }
    await sleep(50);
  }
  throw new Error('the steps do not come so far');
}

beforeAll(async () => {
  mkdirSync(home);
  await rig.startSelector(await freePort(), home, join(rig.folder, 'configs'));
  page = await rig.page();
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

it('makes a machine with a board, and offers its steps', async () => {
  await page.getByTestId('new-machine').click();
  await page.getByTestId('ask-kind').selectOption('lathe');
  await page.getByTestId('ask-drives').selectOption('stepper');
  await page.getByTestId('ask-board').selectOption('7i76e');
  await page.getByTestId('ask-name').fill('Small lathe');
  for (const [key, value] of Object.entries({ 'x.min': '0', 'x.max': '20', 'z.min': '-20', 'z.max': '0', 'pin.estop': '-1' })) {
    await page.getByTestId(`ask-${key}`).fill(value);
    await page.getByTestId(`ask-${key}`).press('Tab');
  }
  await until(async () => !(await page.getByTestId('make').isDisabled()), 'no fault');
  await page.getByTestId('make').click();
  await untilText(page, 'trial', /The test of the first program succeeded/, 60_000);
  await page.getByTestId('wizard-back').click();
  await page.getByTestId('commission-small_lathe/machine.ini').click();
  await page.getByTestId('steps-begin').waitFor();
  await page.getByTestId('steps-simulated').waitFor();
  await judgeByAxe(page, 'before the steps');
}, 120_000);

it('moves only with the button pressed, and a pressed button starts no later motion', async () => {
  await page.getByTestId('steps-begin').click();
  const first = await follow((asked) => asked.ask === 'hold');
  expect(await page.getByTestId('hazard').count()).toBeGreaterThan(0);
  await judgeByAxe(page, 'a motion');
  await pressHold();
  await sleep(700);
  await page.mouse.up();
  await sleep(3000);
  expect((await shown())?.number, 'it stopped').toBe(first.number);
  await pressHold();
  await until(() => isNew(first.number), 'the end of the motion', 20_000);
  const second = await follow((asked) => asked.ask === 'hold');
  await sleep(1000);
  expect((await shown())?.number, 'the pressed button is no new press').toBe(second.number);
  await page.mouse.up();
}, 120_000);

it('ends with the page, and continues where it was', async () => {
  await page.getByTestId('steps-stop').click();
  await untilText(page, 'steps-end', /machine is off/);
  await page.reload();
  await page.getByTestId('commission-small_lathe/machine.ini').click();
  await page.getByTestId('steps-begin').click();
  await follow((asked) => asked.ask === 'hold' || asked.ask === 'confirm');
  expect(await page.locator('[data-state=passed]').count()).toBeGreaterThan(2);
}, 120_000);

it('comes to a ready machine with a corrected scale', async () => {
  const before = readFileSync(join(folder, 'machine.ini'), 'utf8');
  expect(before).toContain('STEP_SCALE = 160');
  // The screw of X has half the pitch that its description states.
  await follow((asked) => /Read the gauge on X/.test(asked.text));
  await answer((await shown()) as Shown, 0.5);
  const end = Date.now() + 240_000;
  while (Date.now() < end && (await page.getByTestId('steps-over').count()) === 0) {
    const asked = await shown();
    if (asked !== null && asked.ask !== 'wait' && asked.ask !== 'do') {
      await answer(asked, 1).catch(async (error: unknown) => {
        if ((await page.getByTestId('steps-over').count()) === 0) {
          throw error;
        }
      });
    }
    await sleep(50);
  }
  await untilText(page, 'steps-end', /The machine is ready/);
  expect(readFileSync(join(folder, 'machine.ini'), 'utf8')).toContain('STEP_SCALE = 320');
  expect(readFileSync(join(folder, 'commissioning.json'), 'utf8')).toContain('"scale"');
  expect(await page.locator('[data-state=fault]').count()).toBe(0);
  await judgeByAxe(page, 'ready');
  await page.getByTestId('language').selectOption('de');
  await untilText(page, 'steps-end', /Maschine ist bereit/);
  expect(errorsOf(page).filter((one) => !/WebSocket|Failed to load/.test(one))).toEqual([]);
}, 400_000);
