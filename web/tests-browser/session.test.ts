// SPDX-License-Identifier: GPL-2.0-or-later
// Tests a longer session: tools, offsets, the text of programs, starts at a line, a paused program whose axes
// are released, and clients that connect and disconnect (G1, D3, J1, J3).
import { readFileSync } from 'node:fs';
import type { ChildProcess } from 'node:child_process';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { bringUp, byHand, errorsOf, Rig, showFailure, sleep, text, until, untilText, judgeByAxe } from './rig';

const PART = `G21 G90 F1500
T1 M6
M3 S1000
G0 Z5
G0 X0 Y0
G1 Z-1
G1 X20
G1 Y20
G1 X0
G1 Y0
G0 Z10
M2
`;

const rig = new Rig(byHand);
let page: Page;
let server: ChildProcess;

async function tab(id: string): Promise<void> {
  await page.getByTestId(`tab-${id}`).click();
}
async function give(line: string): Promise<void> {
  await page.getByTestId('mdi-line').fill(line);
  await page.getByTestId('mdi-line').press('Enter');
}

beforeAll(async () => {
  rig.write('part.ngc', PART);
  server = await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
});

afterEach(async (context) => showFailure(context, page));

afterAll(async () => {
  await rig.end();
});

describe('tools', () => {
  it('are shown, and changed by hand with a question that does not hide the stops', async () => {
    await tab('tools');
    await untilText(page, 'tool-1', /T1.*end mill 6 mm/s);
    await page.getByTestId('load-1').click();
    await untilText(page, 'tool-change', /waits for tool 1/);
    const stop = await page.getByTestId('stop').boundingBox();
    const top = await page.evaluate(([x, y]) => document.elementFromPoint(x ?? 0, y ?? 0)?.textContent?.trim(), [(stop?.x ?? 0) + 20, (stop?.y ?? 0) + 20]);
    expect(top).toBe('Stop');
    await page.getByTestId('tool-change-done').click();
    await untilText(page, 'tool', 'T1');
    expect(await page.getByTestId('tool-change').count()).toBe(0);
  });

  it('request an empty spindle with T0', async () => {
    await give('T0 M6');
    await untilText(page, 'tool-change', /empty spindle/);
    await page.getByTestId('tool-change-done').click();
    await untilText(page, 'tool', 'none');
  });

  it('end their question when the operator stops', async () => {
    await give('T2 M6');
    await untilText(page, 'tool-change', /waits for tool 2/);
    await page.getByTestId('stop').click();
    await until(async () => (await page.getByTestId('tool-change').count()) === 0, 'no question');
    await untilText(page, 'run-state', 'Idle');
  });

  it('are edited, and the table is kept in its file', async () => {
    await page.getByTestId('edit-3').click();
    await page.getByTestId('tool-diameter').fill('9,25');
    await page.getByTestId('tool-offset-Z').fill('55.5');
    await page.getByTestId('tool-save').click();
    await untilText(page, 'tool-3', /55\.500\s+9\.250/);
    const table = rig.ini.replace('.ini', '.tbl');
    await until(() => /T3 .*D\+?9\.25/.test(readFileSync(table, 'utf8')), 'the file');
    expect(readFileSync(table, 'utf8')).toContain('drill 8.5 mm');
  });

  it('are added and removed, in their file, too', async () => {
    const table = rig.ini.replace('.ini', '.tbl');
    const before = readFileSync(table, 'utf8');
    await page.getByTestId('tool-add').click();
    await page.getByTestId('tool-number').fill('77');
    await page.getByTestId('tool-remark').fill('engraver');
    await page.getByTestId('tool-diameter').fill('0,4');
    await page.getByTestId('tool-offset-Z').fill('61.5');
    await judgeByAxe(page, 'a new tool');
    await page.getByTestId('tool-save').click();
    await untilText(page, 'tool-77', /T77\s+Pocket 77, engraver\s+61\.500\s+0\.400/);
    expect(readFileSync(table, 'utf8')).toBe(`${before}T77 P77 Z61.5 D0.4 ;engraver\n`);
    await page.getByTestId('tool-add').click();
    await page.getByTestId('tool-number').fill('78');
    await page.getByTestId('tool-pocket').fill('77');
    await page.getByTestId('tool-save').click();
    await until(async () => (await page.getByText(/pocket 77 is occupied by tool 77/).count()) > 0, 'the refusal');
    await page.getByTestId('tool-dialog').getByRole('button', { name: 'Close' }).click();
    await page.getByTestId('strip-dismiss').click();
    await page.getByTestId('edit-77').click();
    await page.getByTestId('tool-remove').click();
    await page.getByTestId('tool-remove').click();
    await until(async () => (await page.getByTestId('tool-77').count()) === 0, 'that it is gone');
    expect(readFileSync(table, 'utf8')).toBe(before);
  });
});

describe('offsets', () => {
  it('are those of the system that is chosen', async () => {
    await tab('offsets');
    await page.getByTestId('system-G55').click();
    await until(async () => (await page.getByTestId('system-G55').getAttribute('aria-pressed')) === 'true', 'G55');
    await page.getByTestId('offset-touch-Y').click();
    await page.getByTestId('touch-off-value').fill('-3');
    await page.getByTestId('touch-off-set').click();
    await untilText(page, 'g5x-Y', '3.000');
    await untilText(page, 'work-Y', '-3.000');
    // Offsets of other coordinate systems are changed in the table.
    await page.getByTestId('offsets-all').locator('summary').click();
    await page.getByTestId('all-G57-X').click();
    await page.getByTestId('offset-value').fill('12,5');
    await page.getByTestId('offset-set').click();
    await untilText(page, 'all-G57-X', '12.500');
    await untilText(page, 'g5x-X', '0.000');
    await page.getByTestId('offset-clear-Y').click();
    await page.getByTestId('clear-confirm').click();
    await untilText(page, 'g5x-Y', '0.000');
    await page.getByTestId('system-G54').click();
    await until(async () => (await page.getByTestId('system-G54').getAttribute('aria-pressed')) === 'true', 'G54');
  });
});

describe('the text of a program', () => {
  it('shows the errors of the interpreter at their place, and is saved', async () => {
    await tab('programs');
    await page.getByTestId('open-part.ngc').click();
    await page.getByTestId('path-done').waitFor();
    await tab('text');
    await untilText(page, 'text-room', /G1 Z-1/);
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+End');
    await page.keyboard.type('G1 Q9\n');
    await page.getByTestId('text-changed').waitFor();
    expect(await page.getByTestId('run-from-line').getAttribute('aria-disabled')).toBe('true');
    await page.getByTestId('text-save').click();
    await until(() => readFileSync(`${rig.programs}/part.ngc`, 'utf8') === `${PART}G1 Q9\n`, 'the file');
    await page.getByTestId('text-changed').waitFor({ state: 'detached' });
  });

  it('marks a place that cannot be read', async () => {
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+Home');
    await page.keyboard.type('G1 Q9\n');
    await page.getByTestId('text-save').click();
    await page.locator('.cm-lintRange-error, .cm-lint-marker-error').first().waitFor();
    rig.write('part.ngc', PART);
    await tab('programs');
    await page.getByTestId('open-part.ngc').click();
    await page.getByTestId('path-done').waitFor();
  });

  it('starts at a line: the way is shown, and made when it is confirmed', async () => {
    await tab('text');
    await untilText(page, 'text-room', /^.*G21 G90 F1500/s);
    await page.locator('.cm-line', { hasText: 'G1 Y20' }).click();
    await untilText(page, 'run-from-line', 'Run from line 8');
    await page.getByTestId('mdi-line').fill('G10 L2 P1 X-3');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'work-X', (rig.position(0) + 3).toFixed(3));
    const before = rig.position(0);
    await page.getByTestId('run-from-line').click();
    await untilText(page, 'approach', /line 8/);
    await untilText(page, 'approach', /Spindle 0 turns at 1000/);
    await untilText(page, 'approach', /Load tool 1/);
    expect(rig.position(0)).toBe(before);
    expect(rig.pin('spindle.0.on')).toBe('FALSE');
    await page.getByTestId('approach-cancel').click();
    await page.getByTestId('approach').waitFor({ state: 'detached' });
    await untilText(page, 'run-state', 'Idle');
    expect(rig.position(0)).toBe(before);
    await page.getByTestId('run-from-line').click();
    await untilText(page, 'approach', /X 20\.000\s+Y 0\.000\s+Z -1\.000.*Positions in G54, mm/s);
    await untilText(page, 'approach', /Load tool 1/);
    await page.getByTestId('approach-confirm').click();
    await untilText(page, 'tool-change', /tool 1/);
    await page.getByTestId('tool-change-done').click();
    await untilText(page, 'line', /Line (8|9|10)/, 20_000);
    await page.locator('.cm-running').waitFor();
    await untilText(page, 'run-state', 'Idle', 30_000);
    expect(rig.position(1)).toBeCloseTo(0, 5);
    await page.getByTestId('mdi-line').fill('G10 L2 P1 X0');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'work-X', rig.position(0).toFixed(3));
  });
});

describe('a held program', () => {
  it('is left, jogged away from, and gone back to', async () => {
    await page.getByTestId('run').click();
    await untilText(page, 'line', /Line (7|8)/, 20_000);
    await page.getByTestId('hold').click();
    await untilText(page, 'run-state', 'Paused');
    await page.getByTestId('release').click();
    await untilText(page, 'run-state', 'Axes released');
    await page.getByTestId('increment-10').click();
    const before = rig.position(2);
    await page.getByTestId('jog-Z+').click();
    await until(() => Math.abs(rig.position(2) - before - 10) < 1e-6, 'a step up');
    await page.getByTestId('resume').click();
    await untilText(page, 'approach', /where the axes were released/);
    await page.getByTestId('approach-confirm').click();
    await untilText(page, 'run-state', 'Running');
    await untilText(page, 'run-state', 'Idle', 30_000);
    expect(rig.position(0)).toBeCloseTo(0, 5);
  });
});

describe('clients that connect and disconnect', () => {
  it('a killed server is reported at once, nothing is shown as current, and the page continues when it is back', async () => {
    const { port } = rig;
    server.kill('SIGKILL');
    await untilText(page, 'connection', /No connection.*emergency stop at the machine/s);
    await untilText(page, 'state', 'Unknown');
    expect(await page.getByTestId('run').getAttribute('aria-disabled')).toBe('true');
    server = await rig.startServer(port);
    await untilText(page, 'state', 'On', 20_000);
    expect(await page.getByTestId('connection').count()).toBe(0);
  });

  it('a jog ends when the page goes', async () => {
    const other = await rig.page();
    await other.getByTestId('jog-X+').waitFor();
    await other.getByTestId('increment-continuous').click();
    const box = await other.getByTestId('jog-X+').boundingBox();
    const before = rig.position(0);
    await other.mouse.move((box?.x ?? 0) + 20, (box?.y ?? 0) + 20);
    await other.mouse.down();
    await until(() => rig.position(0) > before + 2, 'a jog');
    await other.context().close();
    await sleep(200);
    const there = rig.position(0);
    await sleep(200);
    expect(rig.position(0)).toBe(there);
  });

  it('a jog ends when the page freezes while its button is pressed', async () => {
    await page.getByTestId('increment-continuous').click();
    const box = await page.getByTestId('jog-X-').boundingBox();
    await page.mouse.move((box?.x ?? 0) + 20, (box?.y ?? 0) + 20);
    const before = rig.position(0);
    await page.mouse.down();
    await until(() => rig.position(0) < before - 2, 'a jog');
    const frozen = page.evaluate(() => {
      const end = performance.now() + 1200;
      while (performance.now() < end) {
        // simulates a page whose script hangs
      }
    });
    await sleep(300);
    const there = rig.position(0);
    await sleep(300);
    expect(rig.position(0)).toBe(there);
    await frozen;
    await page.mouse.up();
    await sleep(300);
    expect(rig.position(0)).toBe(there);
  });

  it('has left no error in the page', () => {
    expect(errorsOf(page).filter((one) => !one.includes('WebSocket'))).toEqual([]);
  });
});

describe('languages and appearance (A8)', () => {
  it('change at once, and numbers with them', async () => {
    await tab('settings');
    await page.getByTestId('language').selectOption('de');
    await untilText(page, 'state', 'Ein');
    expect(await text(page, 'work-X')).toMatch(/,\d{3}$/);
    await page.getByTestId('language').selectOption('es');
    await untilText(page, 'state', 'Encendida');
    await page.getByTestId('language').selectOption('en');
    await page.getByTestId('unit').selectOption('inch');
    expect(await text(page, 'work-X')).toMatch(/\.\d{4}$/);
    await page.getByTestId('unit').selectOption('machine');
    await page.getByTestId('theme').selectOption('light');
    expect(await page.evaluate(() => document.documentElement.dataset['theme'])).toBe('light');
    await page.getByTestId('theme').selectOption('auto');
  });
});
