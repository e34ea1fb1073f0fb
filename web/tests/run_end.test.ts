// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { RunWatch } from '../src/lib/run_end';

interface Now {
  s: number;
  interp?: 'IDLE' | 'READING' | 'PAUSED';
  mode?: 'AUTO' | 'MDI';
  line?: number;
  ended?: number;
  stop?: number;
  error?: number;
}
function status({ s, interp = 'IDLE', mode = 'AUTO', line = 0, ended = 0, stop = -1, error = 0 }: Now) {
  return { time_ns: s * 1e9, codes: { g: [], m: [0, stop, 5], settings: [] }, task: { mode, interp_state: interp, program: '/p.ngc', motion_line: line, programs_ended: ended, error_code: error } };
}

describe('the end of a program', () => {
  it('by M2 or M30 is finished, with its time', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1 }));
    watch.take(status({ s: 2, interp: 'READING', line: 3 }));
    expect(watch.take(status({ s: 12, interp: 'READING', line: 9 }))).toBe(false);
    expect(watch.elapsed_s).toBeCloseTo(10, 6);
    expect(watch.take(status({ s: 14, line: 9, ended: 1, stop: 30 }))).toBe(true);
    expect(watch.end).toEqual({ kind: 'finished', program: '/p.ngc', line: 9, seconds: 12 });
    expect(watch.elapsed_s).toBeNull();
    expect(watch.take(status({ s: 15, ended: 1, stop: 30 }))).toBe(false); // still shown
    expect(watch.end?.kind).toBe('finished');
  });

  it('by a stop has the line of the last move, although the status has lost it', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1 }));
    watch.take(status({ s: 2, interp: 'READING', line: 17 }));
    watch.take(status({ s: 5, line: 0, ended: 1 }));
    expect(watch.end).toMatchObject({ kind: 'ended', line: 17, seconds: 3 });
    expect(watch.outcome('FAILED')).toBe(false);
    expect(watch.end?.kind).toBe('stopped');
  });

  it('by its last line, without M2, is finished for the page that has started it', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1 }));
    watch.take(status({ s: 2, interp: 'READING', line: 4 }));
    watch.take(status({ s: 3, line: 4, ended: 1 }));
    expect(watch.outcome('DONE')).toBe(true);
    expect(watch.end?.kind).toBe('finished');
    expect(watch.outcome('DONE')).toBe(false); // counted once
  });

  it('by a stop is one, also where the outcome comes before the status', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1 }));
    watch.take(status({ s: 2, interp: 'READING', line: 4 }));
    expect(watch.outcome('FAILED')).toBe(false);
    watch.take(status({ s: 3, ended: 1 }));
    expect(watch.end).toMatchObject({ kind: 'stopped', line: 4 });
  });

  it('by an error is one, with any M code of the program before', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1, ended: 3, stop: 2 }));
    watch.take(status({ s: 2, interp: 'READING', line: 4, ended: 3 }));
    watch.take(status({ s: 3, ended: 4, stop: 2, error: 5 }));
    expect(watch.end?.kind).toBe('failed');
    expect(watch.outcome('FAILED')).toBe(false);
    expect(watch.end?.kind).toBe('failed');
  });

  it('is seen of a program that was shorter than a status, without its time', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1 }));
    expect(watch.take(status({ s: 2, line: 2, ended: 1, stop: 2 }))).toBe(true);
    expect(watch.end).toMatchObject({ kind: 'finished', seconds: null });
  });

  it('has no time where the page came later, and none of a line of MDI', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1, interp: 'READING', line: 4, ended: 7 }));
    expect(watch.elapsed_s).toBeNull();
    watch.take(status({ s: 3, ended: 8, stop: 2 }));
    expect(watch.end).toMatchObject({ kind: 'finished', seconds: null });
    watch.take(status({ s: 4, mode: 'MDI', interp: 'READING', ended: 8 }));
    expect(watch.take(status({ s: 5, mode: 'MDI', ended: 8 }))).toBe(false);
  });

  it('is forgotten with the next start, and with the machine', () => {
    const watch = new RunWatch();
    watch.take(status({ s: 1 }));
    watch.take(status({ s: 2, line: 2, ended: 1, stop: 2 }));
    watch.take(status({ s: 3, interp: 'READING', line: 2, ended: 1 }));
    expect(watch.end).toBeNull();
    watch.take(null);
    watch.take(status({ s: 0, ended: 0 }));
    expect(watch.end).toBeNull();
  });
});
