// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { CODES, meaningOf } from '../src/lib/i18n/codes';
import { feedUnit, programmed } from '../src/lib/status';

describe('the meaning of modal codes', () => {
  it('is known in three languages, short enough for half a card', () => {
    for (const [code, words] of Object.entries(CODES)) {
      expect(words.length, code).toBe(3);
      for (const one of words) {
        expect(one.trim(), code).not.toBe('');
        expect(one.length, `${code} ${one}`).toBeLessThanOrEqual(30);
      }
    }
    expect(meaningOf('G21', 'de')).toBe('Millimeter');
    expect(meaningOf('G999', 'en')).toBe('');
  });

  it('is known for each code of a machine that was just started', () => {
    for (const code of ['G80', 'G17', 'G40', 'G21', 'G90', 'G94', 'G54', 'G49', 'G99', 'G64', 'G97', 'G91.1', 'G8', 'M5', 'M9', 'M48', 'M53']) {
      expect(meaningOf(code, 'en'), code).not.toBe('');
    }
  });
});

describe('programmed values', () => {
  const codes = (...g: number[]) => ({ g: [0, ...g], m: [], settings: [7, 600.5, 8000, 0.05, 0] });
  it('are feed and speed as words', () => expect(programmed(codes(940))).toEqual({ feed: 600.5, speed: 8000, tolerance: 0.05 }));
  it('of feed have the unit that the codes give it', () => {
    expect(feedUnit(codes(210, 940))).toBe('mm/min');
    expect(feedUnit(codes(200, 940))).toBe('inch/min');
    expect(feedUnit(codes(210, 950))).toBe('mm/rev');
    expect(feedUnit(codes(210, 930))).toBe('1/min');
  });
});
