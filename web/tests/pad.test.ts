// SPDX-License-Identifier: GPL-2.0-or-later
// Tests jogs with a gamepad: they start only with the enable button pressed and a centred stick, and never restart by themselves.
import { beforeEach, expect, it } from 'vitest';
import { DEAD_ZONE, PadJogger, shareOf, STILL_MS, sticksOf, type Pad } from '../src/lib/pad';

const STICKS = sticksOf('mill', 'XYZA');
let did: string[] = [];
let isOpen = true;
let pads: PadJogger;
let clock = 0;

function pad(hold: boolean, axes: number[], more: Partial<Pad> = {}): Pad {
  return { index: 0, connected: true, mapping: 'standard', axes, buttons: Array.from({ length: 17 }, (_, i) => ({ pressed: hold && i === 5 })), timestamp: ++clock, ...more };
}
function look(...all: (Pad | null)[]): string[] {
  did = [];
  pads.look(all, STICKS, (clock += 20));
  return did;
}

beforeEach(() => {
  [isOpen, clock] = [true, 0];
  pads = new PadJogger({
    press: (letter, share) => did.push(`press ${letter} ${share}`),
    change: (letter, share) => did.push(`change ${letter} ${share}`),
    release: (letter) => did.push(`release ${letter}`),
    isOpen: () => isOpen,
    ended: (why) => did.push(why),
  });
});

it('moves nothing without the button, and each axis its way with it', () => {
  expect(look(pad(false, [1, -1, 0, 0]))).toEqual([]);
  expect(look(pad(true, [0, 0, 0, 0]))).toEqual([]);
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual(['press X 1']);
  expect(look(pad(true, [1, -1, 0, 0]))).toEqual(['press Y 1']);
  expect(look(pad(true, [0, 0, 0, 1]))).toEqual(['release X', 'release Y', 'press Z -1']);
  expect(look(pad(true, [0, 0, -1, 0]))).toEqual(['release Z', 'press A -1']);
  expect(look(pad(false, [0, 0, -1, 0]))).toEqual(['release A']);
});

it('begins only with a stick that was centred when the button was pressed', () => {
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]);
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]);
  expect(look(pad(true, [0, 0, 0, 0]))).toEqual([]);
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]); // the hold button was not pressed again
  look(pad(false, [0, 0, 0, 0]));
  look(pad(true, [0, 0, 0, 0]));
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual(['press X 1']);
});

it('has a dead zone, and speeds from its edge on', () => {
  expect(shareOf(DEAD_ZONE)).toBe(0);
  expect(shareOf(-DEAD_ZONE)).toBe(0);
  expect(shareOf(DEAD_ZONE + 0.001)).toBeCloseTo(0.05);
  expect(shareOf(-1)).toBe(-1);
  expect(shareOf(1.2)).toBe(1);
  expect(shareOf(NaN)).toBe(0);
  look(pad(true, [0, 0, 0, 0]));
  expect(look(pad(true, [0.6, 0.1, 0, 0]))).toEqual(['press X 0.5']);
  expect(look(pad(true, [0.8, 0.1, 0, 0]))).toEqual(['change X 0.75']);
  expect(look(pad(true, [-0.8, 0, 0, 0]))).toEqual(['release X']);
  expect(look(pad(true, [-0.8, 0, 0, 0]))).toEqual(['press X -0.75']);
});

it('ends when the pad disconnects, the page loses focus, or a gate closes, and must then be started again', () => {
  look(pad(true, [0, 0, 0, 0]));
  look(pad(true, [1, 0, 0, 0]));
  expect(look(null)).toEqual(['release X', 'lost']);
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]);
  look(pad(false, [0, 0, 0, 0]));
  look(pad(true, [0, 0, 0, 0]));
  look(pad(true, [1, 0, 0, 0]));
  did = [];
  pads.drop();
  expect(did).toEqual(['release X']);
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]);
  look(pad(false, [0, 0, 0, 0]));
  look(pad(true, [0, 0, 0, 0]));
  look(pad(true, [1, 0, 0, 0]));
  isOpen = false;
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual(['release X']);
  isOpen = true;
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]);
  look(pad(false, [0, 0, 0, 0]));
  look(pad(true, [0, 0, 0, 0]));
  look(pad(true, [1, 0, 0, 0]));
  pads.noteEnd(); // the machine has rejected it
  expect(look(pad(true, [1, 0, 0, 0]))).toEqual([]);
});

it('ends when a pad says nothing for long, as one does that has lost its radio', () => {
  look(pad(true, [0, 0, 0, 0]));
  const frozen = pad(true, [1, 0, 0, 0]);
  expect(look(frozen)).toEqual(['press X 1']);
  expect(look(frozen)).toEqual([]);
  clock += STILL_MS;
  expect(look(frozen)).toEqual(['release X', 'still']);
  expect(look(frozen)).toEqual([]);
});

it('keeps to the pad that began, and takes none whose layout is not known', () => {
  look(pad(true, [0, 0, 0, 0]), pad(true, [0, 0, 0, 0], { index: 1 }));
  expect(look(pad(true, [0, 0, 0, 0]), pad(true, [1, 0, 0, 0], { index: 1 }))).toEqual([]);
  look(pad(false, [0, 0, 0, 0]));
  expect(look(pad(true, [0, 0, 0, 0], { mapping: '' }))).toEqual([]);
  expect(look(pad(true, [1, 0, 0, 0], { mapping: '' }))).toEqual([]);
});

it('a lathe moves as its picture shows it', () => {
  expect(sticksOf('lathe', 'XZ')).toEqual([{ letter: 'Z', stick: 0, sign: 1 }, { letter: 'X', stick: 1, sign: 1 }]);
  expect(sticksOf('back_lathe', 'XZ')[1]).toEqual({ letter: 'X', stick: 1, sign: -1 });
  expect(sticksOf('mill', 'XYZ').map((one) => one.letter)).toEqual(['X', 'Y', 'Z']);
});
