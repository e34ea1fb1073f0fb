// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs with a gamepad. An axis moves only while its enable button is pressed and a stick is moved out of its
// centre after the button was pressed. The jog ends when either is released; to start again, both must be
// operated again.

/** State of a pad as the browser reports it. */
export interface Pad {
  index: number;
  connected: boolean;
  mapping: string;
  axes: readonly number[];
  buttons: readonly { pressed: boolean }[];
  /** Time of its last change. [ms] */
  timestamp: number;
}

export interface PadIo {
  /** `share` is a fraction of the jog speed, -1 to 1. */
  press(letter: string, share: number): void;
  change(letter: string, share: number): void;
  release(letter: string): void;
  /** True if a jog is possible. */
  isOpen(): boolean;
  /** The jogs have ended although the operator did not release the stick. */
  ended(why: 'lost' | 'still'): void;
}

/** The direction in which a stick moves an axis. */
export interface StickAxis {
  letter: string;
  stick: number;
  sign: number;
}

/** Both shoulder buttons of the standard layout. */
const HOLD_BUTTONS = [4, 5];
/** Dead zone of a stick, because a worn stick does not return to its centre. */
export const DEAD_ZONE = 0.2;
/** A held stick is never completely still, so a pad without changes for this time has lost its connection. */
export const STILL_MS = 4000;
/** Number of steps in which changes of the speed are sent. */
const STEPS = 20;

/** Mill: left stick X and Y, right stick Z and the fourth axis. Lathe: Z and X as in its picture. */
export function sticksOf(kind: string, axes: string): StickAxis[] {
  const all: StickAxis[] =
    kind === 'lathe' || kind === 'back_lathe'
      ? [{ letter: 'Z', stick: 0, sign: 1 }, { letter: 'X', stick: 1, sign: kind === 'lathe' ? 1 : -1 }]
      : [{ letter: 'X', stick: 0, sign: 1 }, { letter: 'Y', stick: 1, sign: -1 }, { letter: 'Z', stick: 3, sign: -1 }];
  const fourth = [...axes].find((letter) => !'XYZ'.includes(letter));
  if (fourth !== undefined && all.length === 3) {
    all.push({ letter: fourth, stick: 2, sign: 1 });
  }
  return all.filter((one) => axes.includes(one.letter));
}

/** Returns 0 in the dead zone; from its edge it increases linearly to 1. */
export function shareOf(value: number): number {
  const size = Math.abs(value);
  if (!(size > DEAD_ZONE)) {
    return 0;
  }
  const share = Math.min(1, (size - DEAD_ZONE) / (1 - DEAD_ZONE));
  return (Math.sign(value) * Math.max(1, Math.round(share * STEPS))) / STEPS;
}

export class PadJogger {
  private held = new Map<string, number>();
  private isArmed = false;
  private wasHolding = false;
  private pad: number | null = null;
  private lastChange = 0;
  private lastTimestamp = -1;

  constructor(private readonly io: PadIo) {}

  /** Call it every few milliseconds with the result of navigator.getGamepads(). */
  look(pads: readonly (Pad | null)[], sticks: readonly StickAxis[], now: number): void {
    const usable = pads.filter((one): one is Pad => one !== null && one.connected && one.mapping === 'standard');
    const pad = usable.find((one) => one.index === this.pad) ?? (this.pad === null ? usable.find(isHolding) : undefined);
    if (pad === undefined) {
      if (this.pad !== null && this.held.size > 0) {
        this.end('lost');
      }
      this.forget();
      return;
    }
    this.pad = pad.index;
    this.noteChange(pad, now);
    if (!isHolding(pad)) {
      this.releaseAll();
      this.forget();
      return;
    }
    if (!this.wasHolding) {
      this.wasHolding = true;
      this.isArmed = sticks.every((one) => shareOf(pad.axes[one.stick] ?? 0) === 0);
    }
    if (!this.isArmed) {
      return;
    }
    if (!this.io.isOpen()) {
      this.releaseAll();
      this.isArmed = false;
      return;
    }
    if (this.held.size > 0 && now - this.lastChange > STILL_MS) {
      this.end('still');
      return;
    }
    for (const { letter, stick, sign } of sticks) {
      this.move(letter, sign * shareOf(pad.axes[stick] ?? 0));
    }
  }

  /** Called when the page has lost the focus: the button must be pressed again before anything moves. */
  drop(): void {
    this.releaseAll();
    this.isArmed = false;
  }

  /** Called when the machine has ended a jog without a release by the operator. */
  noteEnd(): void {
    this.held.clear();
    this.isArmed = false;
  }

  private move(letter: string, share: number): void {
    const now = this.held.get(letter) ?? 0;
    if (share === now) {
      return;
    }
    if (now !== 0 && Math.sign(share) !== Math.sign(now)) {
      this.held.delete(letter);
      this.io.release(letter);
      return; // the other direction begins with the next call
    }
    this.held.set(letter, share);
    if (now === 0) {
      this.io.press(letter, share);
    } else {
      this.io.change(letter, share);
    }
  }

  private noteChange(pad: Pad, now: number): void {
    if (pad.timestamp !== this.lastTimestamp) {
      this.lastTimestamp = pad.timestamp;
      this.lastChange = now;
    }
  }

  private end(why: 'lost' | 'still'): void {
    this.releaseAll();
    this.isArmed = false;
    this.io.ended(why);
  }

  private releaseAll(): void {
    for (const letter of [...this.held.keys()]) {
      this.held.delete(letter);
      this.io.release(letter);
    }
  }

  private forget(): void {
    this.pad = null;
    this.isArmed = false;
    this.wasHolding = false;
  }
}

function isHolding(pad: Pad): boolean {
  return HOLD_BUTTONS.some((one) => pad.buttons[one]?.pressed === true);
}
