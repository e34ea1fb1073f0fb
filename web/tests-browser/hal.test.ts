// SPDX-License-Identifier: GPL-2.0-or-later
// Tests HAL in the browser: names and values, the oscilloscope, and questions of pins to the operator (B7,
// J2, J3).
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { bringUp, errorsOf, Rig, showFailure, until, untilText } from './rig';

const DIALOGS = `MESSAGE_BOLDTEXT = Door
MESSAGE_TEXT = Close the door
MESSAGE_DETAILS = It is open
MESSAGE_TYPE = okdialog status
MESSAGE_PINNAME = door
MESSAGE_TEXT = Is the probe in?
MESSAGE_BOLDTEXT = Probe
MESSAGE_TYPE = yesnodialog
MESSAGE_PINNAME = probe
MESSAGE_TEXT = The spindle is hot
MESSAGE_BOLDTEXT = Heat
MESSAGE_TYPE = nonedialog
MESSAGE_PINNAME = hot
MULTIMESSAGE_ID = vfd
MULTIMESSAGE_vfd_NUMBER = 1
MULTIMESSAGE_vfd_TYPE = okdialog
MULTIMESSAGE_vfd_TITLE = Drive
MULTIMESSAGE_vfd_TEXT = Overload
MULTIMESSAGE_vfd_NUMBER = 2
MULTIMESSAGE_vfd_TYPE = status
MULTIMESSAGE_vfd_TEXT = Fan stands
`;
const rig = new Rig((ini) => ini.replace('[DISPLAY]\n', `[DISPLAY]\n${DIALOGS}`).replace('[HAL]\n', '[HAL]\nHALUI = halui\n'));
let page: Page;

beforeAll(async () => {
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
}, 90_000);

afterEach(async (context) => showFailure(context, page));

afterAll(async () => {
  await rig.end();
});

describe('names and values', () => {
  it('finds names, watches values as they change, and says which are gone', async () => {
    await page.getByTestId('tab-hal').click();
    await page.getByTestId('hal-find').fill('joint.0 pos-cmd');
    await page.getByTestId('watch-joint.0.pos-cmd').check();
    await untilText(page, 'value-joint.0.pos-cmd', /^-?[\d.e-]+$/);
    const before = await page.getByTestId('value-joint.0.pos-cmd').innerText();
    await page.getByTestId('mdi-line').fill('G0 X3.25');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'value-joint.0.pos-cmd', '3.25');
    expect(before).not.toBe('3.25');
  });

  it('sets pins that HAL allows to set, warns, and reports the reason of a rejection', async () => {
    await page.getByTestId('hal-find').fill('halui.machine.off');
    await page.getByTestId('watch-halui.machine.off').check();
    await page.getByTestId('set-halui.machine.off').click();
    await page.getByTestId('hal-value').fill('perhaps');
    await page.getByTestId('hal-set-now').click();
    await untilText(page, 'hal-set-failed', /perhaps/);
    await page.getByTestId('hal-value').fill('1');
    await page.getByTestId('hal-set-now').click();
    await untilText(page, 'state', 'Off'); // shows the real value
    rig.setPin('halui.machine.off', '0');
    await page.getByTestId('on').click();
    await untilText(page, 'state', 'On');
    expect(await page.getByTestId('set-joint.0.pos-cmd').count()).toBe(0); // its writer is motion
  });
});

describe('the oscilloscope', () => {
  it('records a move around its trigger, cycle by cycle', async () => {
    await page.getByTestId('hal-scope').click();
    await page.getByTestId('scope-trigger').selectOption('RISING');
    await page.getByTestId('scope-source').selectOption('joint.0.pos-cmd');
    await page.getByTestId('scope-level').fill('5');
    await page.getByTestId('scope-samples').fill('400');
    await page.getByTestId('scope-start').click();
    await untilText(page, 'scope-state', 'Waiting for the trigger');
    await page.getByTestId('mdi-line').fill('G0 X10');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'scope-state', 'Recorded');
    await until(async () => (await page.getByTestId('scope-plot').getAttribute('data-samples')) === '400', 'the record');
    const csv = decodeURIComponent((await page.getByTestId('scope-save').getAttribute('href')) ?? '').split('\n');
    expect(csv[0]).toContain('joint.0.pos-cmd');
    const rows = csv.slice(1, 401).map((line) => line.split(',').map(Number));
    const at = rows.findIndex((row) => row[0] === 0);
    expect(at).toBe(80); // 20 percent before the trigger
    expect(rows[at - 1]?.[1]).toBeLessThanOrEqual(5);
    expect(rows[at]?.[1]).toBeGreaterThan(5);
    for (let i = 1; i < rows.length; ++i) {
      expect((rows[i]?.[0] ?? 0) - (rows[i - 1]?.[0] ?? 0)).toBeGreaterThan(0);
    }
    await page.getByTestId('scope-end').click();
    await untilText(page, 'scope-state', 'Not recording');
  });
});

describe('what pins ask', () => {
  it('a question is answered, and HAL has the answer', async () => {
    rig.setPin('screen.probe', '1');
    await page.getByTestId('question-no').waitFor();
    expect(rig.pin('screen.probe-waiting')).toBe('TRUE');
    await page.getByTestId('question-yes').click();
    await until(() => rig.pin('screen.probe') === 'FALSE', 'the pin');
    expect(rig.pin('screen.probe-response')).toBe('TRUE');
    expect(rig.pin('screen.probe-waiting')).toBe('FALSE');
    await until(async () => (await page.getByTestId('question').count()) === 0, 'its end');
  });

  it('a dialog is closed, and noted', async () => {
    rig.setPin('screen.door', '1');
    await untilText(page, 'question', /Close the door\s*It is open/);
    await page.getByTestId('estop').dispatchEvent('pointerdown'); // no dialog covers the stops
    await untilText(page, 'state', 'Emergency stop');
    await page.getByTestId('question-ok').click();
    await until(() => rig.pin('screen.door') === 'FALSE', 'the pin');
    await page.getByTestId('tab-messages').click();
    await untilText(page, 'messages', /Door: Close the door/);
  });

  it('what lasts is shown until its pin says otherwise, and has no button', async () => {
    rig.setPin('screen.hot', '1');
    await untilText(page, 'lasting-hot', /Heat The spindle is hot/);
    rig.setPin('screen.hot', '0');
    await until(async () => (await page.getByTestId('lasting-hot').count()) === 0, 'its end');
  });

  it('a number chooses the text; a note needs no answer', async () => {
    rig.setPin('screen.vfd', '2');
    await untilText(page, 'messages', /Fan stands/);
    await until(() => rig.pin('screen.vfd') === '0', 'the pin');
    rig.setPin('screen.vfd', '1');
    await untilText(page, 'question', /Overload/);
    await page.getByTestId('question-ok').click();
    await until(() => rig.pin('screen.vfd') === '0', 'the pin');
    expect(errorsOf(page)).toEqual([]);
  });
});
