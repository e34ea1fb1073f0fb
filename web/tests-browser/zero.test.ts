// SPDX-License-Identifier: GPL-2.0-or-later
// Tests work zeros with one touch and their undo, and moves to zero after a confirmation. Motion is read from
// HAL.
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { errorsOf, judgeByAxe, Rig, showFailure, sleep, text, until, untilText } from './rig';

const rig = new Rig();
let page: Page;

async function mdi(line: string): Promise<void> {
  await page.getByTestId('mdi-line').fill(line);
  await page.getByTestId('mdi-send').click();
  await page.locator('[data-testid="mdi"][aria-busy="false"]').waitFor();
  await untilText(page, 'run-state', 'Idle');
}
async function stopsAt(x: number, y: number, z: number): Promise<void> {
  await until(() => [x, y, z].every((value, joint) => Math.abs(rig.position(joint) - value) < 1e-6), `a standstill at ${x} ${y} ${z}`);
  await untilText(page, 'run-state', 'Idle');
}
async function untilWork(x: string, y: string, z: string): Promise<void> {
  await untilText(page, 'work-X', x);
  await untilText(page, 'work-Y', y);
  await untilText(page, 'work-Z', z);
}
/** MDI lines that this page has sent. */
async function linesOf(act: () => Promise<void>): Promise<string[]> {
  await page.evaluate(() => {
    const sent = window as unknown as { lines?: string[]; real?: (text: string) => void };
    const real = WebSocket.prototype.send;
    sent.lines = [];
    sent.real ??= real as (text: string) => void;
    WebSocket.prototype.send = function (this: WebSocket, data: string | ArrayBufferLike | Blob | ArrayBufferView): void {
      const line = typeof data === 'string' ? /"line":"([^"]*)"/.exec(data)?.[1] : undefined;
      if (line !== undefined) {
        sent.lines?.push(line);
      }
      (sent.real as (text: unknown) => void).call(this, data);
    };
  });
  await act();
  return page.evaluate(() => (window as unknown as { lines: string[] }).lines);
}

beforeAll(async () => {
  rig.write('long.ngc', 'G21 G90 F300\nG1 X60\nG1 X0\nM2\n');
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

describe('before homing', () => {
  it('no zero can be set and no move can start', async () => {
    await page.getByTestId('reset').click();
    await page.getByTestId('on').click();
    await untilText(page, 'state', 'On');
    await page.getByTestId('touch-X').click({ force: true });
    await untilText(page, 'why', /not homed/);
    for (const id of ['zero-X', 'zero-XY', 'zero-all', 'go-zero-XY', 'go-zero-Z']) {
      expect(await page.getByTestId(id).count(), id).toBe(0);
    }
    await bringUpRest();
  });
});

async function bringUpRest(): Promise<void> {
  await page.getByTestId('home-all').click();
  await untilText(page, 'run-state', 'Homing');
  await untilText(page, 'run-state', 'Idle', 30_000);
  await mdi('G0 X12 Y7 Z20');
  await stopsAt(12, 7, 20);
}

describe('one touch', () => {
  it('sets the zero of one axis, and Undo restores the former one', async () => {
    await page.getByTestId('zero-X').click();
    await untilWork('0.000', '7.000', '20.000');
    await untilText(page, 'zero-text', /G54: X set to zero.*Previous offset: X 0\.000/s);
    await page.getByTestId('zero-undo').click();
    await untilWork('12.000', '7.000', '20.000');
    await page.getByTestId('zero-undo').waitFor({ state: 'detached' });
  });

  it('sets XY, then all, and each is undone in its turn', async () => {
    await page.getByTestId('zero-XY').click();
    await untilWork('0.000', '0.000', '20.000');
    await page.getByTestId('zero-undo').waitFor();
    await page.getByTestId('zero-all').click();
    await untilWork('0.000', '0.000', '0.000');
    await untilText(page, 'zero-text', /X Y Z set to zero/);
    await judgeByAxe(page, 'undo of a zero');
    await page.getByTestId('zero-undo').click();
    await untilWork('0.000', '0.000', '20.000');
    await page.getByTestId('zero-undo').click();
    await untilWork('12.000', '7.000', '20.000');
  });

  it('is one command, however often the button is touched', async () => {
    const lines = await linesOf(async () => {
      await page.getByTestId('zero-Y').evaluate((button: HTMLElement) => {
        for (let i = 0; i < 5; ++i) {
          button.click();
        }
      });
      await untilWork('12.000', '0.000', '20.000');
      await sleep(200);
    });
    expect(lines).toEqual(['G10 L20 P0 Y0']);
    await page.getByTestId('zero-undo').click();
    await untilWork('12.000', '7.000', '20.000');
  });

  it('sets the active coordinate system, also a rotated one in inches, and restores all of it', async () => {
    await mdi('G55 G20 G10 L2 P2 X0.1 Y0.2 Z0.3 R30');
    const before = await text(page, 'work-Y');
    await page.getByTestId('zero-X').click();
    await untilText(page, 'zero-text', /G55: X set to zero.*X 2\.540/s);
    await untilText(page, 'work-X', '0.000');
    await page.getByTestId('zero-undo').click();
    await page.getByTestId('zero-undo').waitFor({ state: 'detached' });
    expect(await text(page, 'work-Y')).toBe(before);
    await page.getByTestId('tab-offsets').click();
    await untilText(page, 'g5x-X', '2.540');
    await untilText(page, 'g5x-Y', '5.080');
    await page.getByTestId('tab-path').click();
    await mdi('G10 L2 P2 X0 Y0 Z0 R0 G21');
    await mdi('G54');
  });

  it('is not set while the machine moves', async () => {
    const box = await page.getByTestId('jog-X+').boundingBox();
    await page.mouse.move((box?.x ?? 0) + 20, (box?.y ?? 0) + 20);
    await page.mouse.down();
    await untilText(page, 'run-state', 'Moving');
    const lines = await linesOf(async () => {
      await page.getByTestId('zero-X').evaluate((button: HTMLElement) => button.click());
      await untilText(page, 'why', /The machine is moving/);
      await page.mouse.up();
    });
    expect(lines).toEqual([]);
    await untilText(page, 'run-state', 'Idle');
    await mdi('G0 X12');
    await stopsAt(12, 7, 20);
  });

  it('is no longer undone once something else has changed the offsets', async () => {
    await page.getByTestId('zero-X').click();
    await page.getByTestId('zero-undo').waitFor();
    await mdi('G10 L2 P1 X3');
    await page.getByTestId('zero-undo').waitFor({ state: 'detached' });
    await mdi('G10 L2 P1 X0');
    await untilWork('12.000', '7.000', '20.000');
  });

  it('asks first where the active length is that of another tool', async () => {
    await mdi('T2 M6'); // at the position of tool changes
    await untilText(page, 'tool', 'T2');
    await mdi('G43 H1');
    await mdi('G0 X12 Y7');
    await untilText(page, 'length', /Length: T1.*T2 is in the spindle/s);
    await untilText(page, 'work-X', '12.000');
    await untilText(page, 'work-Y', '7.000');
    await untilText(page, 'run-state', 'Idle');
    const before = await text(page, 'work-Z');
    await page.getByTestId('zero-all').click();
    await untilText(page, 'length-choice', /wrong for Z/);
    await sleep(300);
    await untilWork('12.000', '7.000', before);
    await page.getByTestId('zero-apply').click();
    await untilWork('0.000', '0.000', '0.000');
    await untilText(page, 'length', 'Length: T2');
    await page.getByTestId('zero-undo').click();
    await untilText(page, 'work-X', '12.000');
    await mdi('G49');
    await mdi('G0 Z20');
    await stopsAt(12, 7, 20);
  });
});

describe('a move to zero', () => {
  it('starts by nothing but its confirmation', async () => {
    await page.getByTestId('go-zero-XY').click();
    await untilText(page, 'go-zero', /X: from 12\.000 mm to 0.*Y: from 7\.000 mm to 0.*Z does not move. It stays at 20\.000/s);
    await judgeByAxe(page, 'a move to zero');
    await sleep(300);
    await page.getByTestId('go-zero').getByText('Close').click();
    await sleep(300);
    expect([rig.position(0), rig.position(1), rig.position(2)]).toEqual([12, 7, 20]);
  });

  it('moves X and Y at the present height, by one command', async () => {
    await page.getByTestId('go-zero-XY').click();
    const lines = await linesOf(async () => {
      await page.getByTestId('go-zero-confirm').evaluate((button: HTMLElement) => {
        button.click();
        button.click();
      });
      await stopsAt(0, 0, 20);
    });
    expect(lines).toEqual(['G0 X0 Y0']);
  });

  it('moves Z by its own button alone', async () => {
    await page.getByTestId('go-zero-Z').click();
    await page.getByTestId('go-zero-confirm').click();
    await stopsAt(0, 0, 0);
    await mdi('G0 X12 Y7 Z20');
    await stopsAt(12, 7, 20);
  });

  it('does not start once the offsets are others than those shown', async () => {
    await page.getByTestId('go-zero-XY').click();
    const other = await rig.page();
    await other.getByTestId('zero-Y').click();
    await untilText(page, 'go-zero-gate', /offsets have changed/);
    await page.getByTestId('go-zero-confirm').click({ force: true });
    await sleep(300);
    expect(rig.position(0)).toBe(12);
    await page.getByTestId('go-zero').getByText('Close').click();
    await other.getByTestId('zero-undo').click();
    await untilText(page, 'work-Y', '7.000');
    await other.context().close();
  });

  it('is rejected under G91, and while a program runs or is paused', async () => {
    await mdi('G91');
    await page.getByTestId('go-zero-XY').click({ force: true });
    await untilText(page, 'why', /G91/);
    await mdi('G90');
    await page.getByTestId('tab-programs').click();
    await page.getByTestId('open-long.ngc').click();
    await page.getByTestId('run').click();
    await untilText(page, 'run-state', 'Running');
    await page.getByTestId('go-zero-XY').click({ force: true });
    await untilText(page, 'why', /A program is running/);
    await page.getByTestId('zero-all').click({ force: true });
    await untilText(page, 'why', /A program is running/);
    await page.getByTestId('hold').click();
    await untilText(page, 'run-state', 'Paused');
    await page.getByTestId('go-zero-Z').click({ force: true });
    await untilText(page, 'why', /A program is paused/);
    expect(await page.getByTestId('go-zero').count()).toBe(0);
    await page.getByTestId('stop').click();
    await untilText(page, 'run-state', 'Idle');
  });

  it('with a wrong tool length shows that before it is confirmed', async () => {
    await mdi('G43 H1');
    await page.getByTestId('go-zero-Z').click();
    await untilText(page, 'go-zero-length', /T2 is in the spindle. The length of T1 is active.*does not stop at zero/);
    await page.getByTestId('go-zero').getByText('Close').click();
    expect(errorsOf(page)).toEqual([]);
  });
});
