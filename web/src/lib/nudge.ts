// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of an override. Each touch is relative to the sum of the earlier touches, although the status follows
// later.

/** For this time [ms] after its command, a requested value is valid even if the machine does not report it. */
const LATE_MS = 500;

export interface NudgeRange {
  min: number;
  max: number;
}

export class Nudger {
  private wanted: number | null = null;
  private isSending = false;
  private sentAt = 0;

  /** `send` sets the override; `now` is in ms. */
  constructor(
    private readonly send: (value: number) => Promise<unknown>,
    private readonly now: () => number,
  ) {}

  /** The requested value, or the reported value if all requests are done. */
  current(reported: number): number {
    const isLate = !this.isSending && this.now() - this.sentAt > LATE_MS;
    if (this.wanted !== null && !this.isSending && (this.wanted === reported || isLate)) {
      this.wanted = null;
    }
    return this.wanted ?? reported;
  }

  step(by: number, reported: number, range: NudgeRange): void {
    this.set(Math.min(Math.max(this.current(reported) + by, range.min), range.max));
  }

  /** Sends one command at a time. Of the requests made in the meantime, only the newest is sent. */
  set(value: number): void {
    this.wanted = value;
    if (!this.isSending) {
      this.isSending = true;
      void this.sendAll();
    }
  }

  private async sendAll(): Promise<void> {
    let sent: number | null = null;
    while (this.wanted !== null && this.wanted !== sent) {
      sent = this.wanted;
      await this.send(sent);
    }
    this.sentAt = this.now();
    this.isSending = false;
  }
}
