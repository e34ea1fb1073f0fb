// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { Nudger } from '../src/lib/nudge';

const RANGE = { min: 0, max: 150 };

function rig() {
  const sent: number[] = [];
  const waiting: (() => void)[] = [];
  let now = 0;
  const nudger = new Nudger((value) => (sent.push(value), new Promise<void>((done) => waiting.push(done))), () => now);
  return {
    nudger,
    sent,
    async done(): Promise<void> {
      waiting.shift()?.();
      await new Promise((later) => setTimeout(later));
    },
    wait: (ms: number) => (now += ms),
  };
}

describe('steps of an override', () => {
  it('add up, although the status comes later', async () => {
    const { nudger, sent, done } = rig();
    nudger.step(10, 100, RANGE);
    nudger.step(10, 100, RANGE);
    nudger.step(10, 100, RANGE);
    expect(sent).toEqual([110]);
    await done();
    expect(sent).toEqual([110, 130]);
    await done();
    nudger.step(-10, 110, RANGE); // the status so far shows only the first step
    expect(sent).toEqual([110, 130, 120]);
  });
  it('stay within what the machine allows', async () => {
    const { nudger, sent, done } = rig();
    nudger.step(10, 145, RANGE);
    await done();
    nudger.step(-500, 150, RANGE);
    expect(sent).toEqual([150, 0]);
  });
  it('count from what the machine reports once it has', async () => {
    const { nudger, sent, done } = rig();
    nudger.step(10, 100, RANGE);
    await done();
    expect(nudger.current(110)).toBe(110);
    nudger.step(10, 60, RANGE); // another screen has changed it
    expect(sent).toEqual([110, 70]);
  });
  it('count from what the machine reports where it did not take a step', async () => {
    const { nudger, sent, done, wait } = rig();
    nudger.step(10, 100, RANGE);
    await done();
    wait(600);
    nudger.step(10, 100, RANGE);
    expect(sent).toEqual([110, 110]);
  });
});
