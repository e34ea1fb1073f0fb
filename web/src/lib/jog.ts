// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs with leases: motion ends a continuous jog that is not renewed, so that an axis stops after a frozen
// page, a cut cable or a killed server. The end of the touch ends the jog for any reason; nothing here
// restarts it.
import type { Command, Outcome } from './link';

export const LEASE_MS = 100;
export const RENEWAL_MS = 30;

export interface JogIo {
  post(command: Command): Promise<Outcome>;
  /** Sets mode and jog mode; false if this is not possible, which has been reported. */
  prepare(isJoint: boolean): Promise<boolean>;
  isPrepared(isJoint: boolean): boolean;
  every(act: () => void, ms: number): unknown;
  cancel(timer: unknown): void;
  /** Called when a jog has ended although the operator did not release it. */
  ended(reason: string): void;
}

export interface Jog {
  isJoint: boolean;
  index: number;
  /** Signed; units per second. */
  velocity: number;
  /** Distance, above 0; null: continuous while held. */
  increment: number | null;
}

interface Held {
  jog: Jog;
  timer: unknown;
  hasBegun: boolean;
}

export class Jogger {
  private held = new Map<string, Held>();

  constructor(private readonly io: JogIo) {}

  get isJogging(): boolean {
    return this.held.size > 0;
  }

  async press(jog: Jog): Promise<void> {
    const key = `${jog.isJoint ? 'joint' : 'axis'} ${jog.index}`;
    if (this.held.has(key) || jog.velocity === 0) {
      return;
    }
    const held: Held = { jog, timer: null, hasBegun: false };
    this.held.set(key, held);
    if (!this.io.isPrepared(jog.isJoint) && !(await this.io.prepare(jog.isJoint))) {
      this.drop(key, held);
      return;
    }
    if (this.held.get(key) !== held) {
      return; // released during the change of mode
    }
    if (jog.increment !== null) {
      this.drop(key, held); // ends by itself; a release does not stop it
      await this.step(jog, jog.increment);
      return;
    }
    await this.hold(key, held);
  }

  /** Ends the jogs of this axis or joint at once, independent of other operations. */
  release(isJoint: boolean, index: number): void {
    const key = `${isJoint ? 'joint' : 'axis'} ${index}`;
    const held = this.held.get(key);
    if (held === undefined) {
      return;
    }
    this.drop(key, held);
    if (held.hasBegun) {
      void this.io.post({ message: 'JogStop', is_joint: isJoint, index });
    }
  }

  /** Signed; the jog continues with this speed. Another direction ends the jog. */
  changeSpeed(isJoint: boolean, index: number, velocity: number): void {
    const held = this.held.get(`${isJoint ? 'joint' : 'axis'} ${index}`);
    if (held === undefined) {
      return;
    }
    if (Math.sign(velocity) !== Math.sign(held.jog.velocity)) {
      this.release(isJoint, index);
      return;
    }
    held.jog = { ...held.jog, velocity }; // sent with the next renewal
  }

  releaseAll(): void {
    for (const { jog } of [...this.held.values()]) {
      this.release(jog.isJoint, jog.index);
    }
  }

  private async step(jog: Jog, increment: number): Promise<void> {
    const outcome = await this.io.post({
      message: 'JogIncrement',
      is_joint: jog.isJoint,
      index: jog.index,
      velocity: Math.abs(jog.velocity),
      distance: Math.sign(jog.velocity) * increment,
    });
    this.tell(outcome);
  }

  private async hold(key: string, held: Held): Promise<void> {
    const { jog } = held;
    const command: Command = {
      message: 'JogContinuous',
      is_joint: jog.isJoint,
      index: jog.index,
      velocity: jog.velocity,
      lease_ms: LEASE_MS,
    };
    held.hasBegun = true;
    held.timer = this.io.every(() => {
      void this.io.post({ ...command, velocity: held.jog.velocity, is_renewal: true }).then((outcome) => this.judge(key, held, outcome));
    }, RENEWAL_MS);
    this.judge(key, held, await this.io.post({ ...command }));
  }

  private judge(key: string, held: Held, outcome: Outcome): void {
    const isHeld = this.held.get(key) === held;
    if (isHeld && (outcome.progress === 'REFUSED' || outcome.progress === 'FAILED')) {
      this.drop(key, held);
      this.tell(outcome);
    }
  }

  private tell(outcome: Outcome): void {
    if (outcome.progress === 'REFUSED' || outcome.progress === 'FAILED') {
      this.io.ended(outcome.reason);
    }
  }

  private drop(key: string, held: Held): void {
    if (held.timer !== null) {
      this.io.cancel(held.timer);
    }
    if (this.held.get(key) === held) {
      this.held.delete(key);
    }
  }
}
