// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the effects of [DISPLAY] and [HAL]POSTGUI_... on the screen: title, stored lines and preferences,
// panels, additional programs (J1, J2).
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { bringUp, errorsOf, Rig, showFailure, text, until, untilText } from './rig';

const PANEL = JSON.stringify({
  parts: [
    { kind: 'lamp', label: 'Machine on', name: 'motion.motion-enabled' },
    { kind: 'value', label: 'X', name: 'joint.0.pos-cmd', unit: 'mm', decimals: 1 },
    { kind: 'bar', label: 'Spindle', name: 'spindle.0.speed-out', max: 1000 },
    { kind: 'switch', label: 'Coolant by hand', name: 'own-switch' },
    { kind: 'button', label: 'Hold me', name: 'own-button' },
    { kind: 'number', label: 'Depth', name: 'own-number', unit: 'mm' },
  ],
});
const DISPLAY = `TITLE = The big mill
ICON = icon.svg
MDI_HISTORY_FILE = mdi.txt
PREFERENCE_FILE_PATH = WORKINGFOLDER/screen.json
SPINDLE_INCREMENT = 50
DEFAULT_SPINDLE_SPEED = 400
MAX_SPINDLE_SPEED = 480
EMBED_TAB_NAME = Shop
EMBED_TAB_COMMAND = panel shop.json
EMBED_TAB_NAME = Side
EMBED_TAB_COMMAND = /bin/sh -c 'echo $INI_FILE_NAME > side.txt; exec sleep 600'
MESSAGE_TEXT = Door
MESSAGE_TYPE = okdialog
MESSAGE_PINNAME = door
`;
const rig = new Rig((ini) =>
  ini.replace('[DISPLAY]\n', `[DISPLAY]\n${DISPLAY}`).replace('[HAL]\n', '[HAL]\nPOSTGUI_HALFILE = post.hal\nPOSTGUI_HALCMD = newsig from-command bit\nPOSTGUI_HALCMD = nonsense\n'),
);
const folder = join(rig.folder, 'configs/sim');
let page: Page;

beforeAll(async () => {
  writeFileSync(join(folder, 'shop.json'), PANEL);
  writeFileSync(join(folder, 'mdi.txt'), 'G0 X1\nG0 Y2\n');
  writeFileSync(join(folder, 'icon.svg'), '<svg xmlns="http://www.w3.org/2000/svg"/>');
  writeFileSync(join(folder, 'post.hal'), 'net door-open screen.door\nnewsig own-switch bit\nnewsig own-button bit\nnewsig own-number float\n');
  await rig.startMachine();
  await rig.startServer(0, ['--display']);
  page = await rig.page();
  await bringUp(page);
}, 90_000);

afterEach(async (context) => showFailure(context, page));

afterAll(async () => {
  await rig.end();
});

it('has the title and the picture of the file', async () => {
  await until(async () => (await page.title()) === 'The big mill', 'the title');
  expect(await page.evaluate(() => document.querySelector('link[rel="icon"]')?.getAttribute('href'))).toBe('/api/icon');
  expect(await page.evaluate(async () => (await fetch('/api/icon')).headers.get('content-type'))).toBe('image/svg+xml');
});

it('runs programs that wait for its pins, and reports failures', async () => {
  await until(() => rig.signal('door-open') === 'FALSE', 'the link of post.hal');
  await until(() => rig.signal('from-command') === 'FALSE', 'the signal of POSTGUI_HALCMD');
  await page.getByTestId('tab-messages').click();
  await untilText(page, 'messages', /POSTGUI.*nonsense/s, 30_000);
});

it('keeps lines of MDI in the file that other screens read', async () => {
  await page.getByTestId('mdi-line').fill('G0 Z7');
  await page.getByTestId('mdi-send').click();
  await until(() => readFileSync(join(folder, 'mdi.txt'), 'utf8') === 'G0 X1\nG0 Y2\nG0 Z7\n', 'the line');
});

it('keeps preferences at the machine, for every browser', async () => {
  await page.getByTestId('tab-settings').click();
  await page.getByTestId('language').selectOption('de');
  await until(() => existsSync(join(folder, 'screen.json')) && (JSON.parse(readFileSync(join(folder, 'screen.json'), 'utf8')) as { language: string }).language === 'de', 'the file');
  const other = await rig.page();
  await untilText(other, 'tab-settings', 'Einstellungen');
  await other.context().close();
  await page.getByTestId('language').selectOption('en');
});

it('changes the spindle by the increment of the INI file, up to its maximum speed', async () => {
  await page.getByTestId('spindle-forward-0').click();
  await untilText(page, 'spindle-state-0', /400/);
  await page.getByTestId('spindle-faster-0').click();
  await untilText(page, 'spindle-state-0', /450/);
  await page.getByTestId('spindle-faster-0').click();
  await untilText(page, 'spindle-state-0', /480/);
  await page.getByTestId('spindle-stop-0').click();
});

it('shows a panel of the shop, bound to HAL both ways', async () => {
  await page.getByTestId('tab-embedded-0').click();
  await untilText(page, 'shown-motion.motion-enabled', 'on');
  await untilText(page, 'shown-joint.0.pos-cmd', /^-?\d+\.\d mm$/);
  await page.getByTestId('switch-own-switch').click();
  await until(() => rig.signal('own-switch') === 'TRUE', 'the switch');
  const [pressed] = await Promise.all([page.waitForResponse(/own-button/), page.getByTestId('press-own-button').click()]);
  expect(pressed.status()).toBe(200);
  expect(rig.signal('own-button')).toBe('FALSE'); // a pulse: the server restores the value
  await page.getByTestId('number-own-number').fill('2,5');
  await page.getByTestId('send-own-number').click();
  await until(() => Number(rig.signal('own-number')) === 2.5, 'the number');
});

it('starts a program with its own window', async () => {
  await until(() => existsSync(join(folder, 'side.txt')) && readFileSync(join(folder, 'side.txt'), 'utf8').includes('mill_mm.ini'), 'the program');
  await page.getByTestId('tab-embedded-1').click();
  expect(await text(page, 'embedded')).toContain('opens in its own window');
});

it('shows the offsets of all systems as the machine has them', async () => {
  await page.getByTestId('mdi-line').fill('G10 L2 P3 X12.5 Y-4');
  await page.getByTestId('mdi-send').click();
  await page.getByTestId('tab-offsets').click();
  await page.getByTestId('offsets-all').locator('summary').click();
  await untilText(page, 'all-G56', /G56\s+12\.500\s+-4\.000/);
  expect(errorsOf(page)).toEqual([]);
});
