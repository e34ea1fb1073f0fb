// SPDX-License-Identifier: GPL-2.0-or-later
// The commissioning steps at a machine: a socket to `millwright select --browser`, which runs them.
// docs/reference/api.md, First steps.

export type Ask = 'wait' | 'confirm' | 'hold' | 'do' | 'number' | 'choice';
export interface Prompt {
  step: string;
  motor: string;
  ask: Ask;
  text: string;
  choices: string[];
  unit: string;
  hazards: string[];
  watch: string;
  /** The operator may end the motion by releasing the button and confirming. */
  may_end_early: boolean;
}
export interface StepValue {
  name: string;
  number: number;
  unit: string;
}
export interface StepState {
  name: string;
  title: string;
  state: 'due' | 'passed' | 'fault';
  fault?: string;
  remedy?: string;
  detail?: string;
  values?: StepValue[];
}
export interface StepsState {
  state: 'running' | 'done' | 'ready' | 'fault' | 'error';
  error: string;
  number?: number;
  prompt?: Prompt;
  current?: number;
  steps?: StepState[];
}

/** Below the time after which a button counts as released, 250 ms. */
const RENEWAL_MS = 80;

/** The methods of a socket that are used, so that a test can replace it. */
export interface StepsSocket {
  onopen: (() => void) | null;
  onmessage: ((event: { data: string }) => void) | null;
  onclose: (() => void) | null;
  readonly bufferedAmount: number;
  send(text: string): void;
  close(): void;
}

/** One session. It ends with its socket, and the machine is then switched off. */
export class StepsSession {
  shown = $state.raw<StepsState | null>(null);
  isClosed = $state(false);
  private renewal: ReturnType<typeof setInterval> | null = null;
  private pressedFor = -1;

  constructor(private readonly socket: StepsSocket, first: { key: string; ini: string }) {
    socket.onopen = () => socket.send(JSON.stringify(first));
    socket.onmessage = (event) => {
      this.shown = JSON.parse(event.data) as StepsState;
      if (this.shown.number !== this.pressedFor) {
        this.stopRenewal();
      }
    };
    socket.onclose = () => {
      this.stopRenewal();
      this.isClosed = true;
    };
  }

  private send(act: object, number = this.shown?.number): void {
    if (!this.isClosed && number !== undefined) {
      this.socket.send(JSON.stringify({ number, ...act }));
    }
  }
  private stopRenewal(): void {
    if (this.renewal !== null) {
      clearInterval(this.renewal);
      this.renewal = null;
    }
    this.pressedFor = -1;
  }

  /** A press applies only to the motion that is shown now. */
  press(): void {
    this.stopRenewal();
    const number = this.shown?.number;
    if (number === undefined) {
      return;
    }
    this.pressedFor = number;
    this.send({ act: 'hold' }, number);
    this.renewal = setInterval(() => {
      // Data that cannot be sent at once are not sent later.
      if (this.socket.bufferedAmount === 0) {
        this.send({ act: 'hold' }, number);
      }
    }, RENEWAL_MS);
  }
  release(): void {
    if (this.renewal !== null) {
      this.stopRenewal();
      this.send({ act: 'release' });
    }
  }
  confirm = (): void => this.send({ act: 'confirm' });
  cannot = (): void => this.send({ act: 'cannot' });
  measure = (value: number): void => this.send({ act: 'number', value });
  choose = (choice: string): void => this.send({ act: 'choice', choice });
  /** Called when the machine is switched off. */
  end(): void {
    this.stopRenewal();
    this.socket.close();
  }
}
