// SPDX-License-Identifier: GPL-2.0-or-later
// The socket to the server: commands with ids and outcomes, the status, messages. It reconnects by itself.

export type Progress = 'STARTED' | 'DONE' | 'REFUSED' | 'FAILED';

export interface Outcome {
  progress: Progress;
  reason: string;
}

export interface Command {
  message: string;
  [field: string]: unknown;
}

export interface Message {
  number: number;
  /** Identifies the start of the machine that numbers the messages. */
  run: string;
  kind: 'OPERATOR_ERROR' | 'OPERATOR_TEXT' | 'OPERATOR_DISPLAY';
  text: string;
}

/** null: the name does not exist, or its number is not finite. */
export type HalValue = number | boolean | null;

/** A question from a HAL pin to the operator, or a text that is shown while the pin is set ('none'). */
export interface Question {
  id: string;
  number: number;
  kind: 'ok' | 'yesno' | 'none';
  title: string;
  text: string;
  details: string;
  icon: string;
}

export interface Hello {
  version: string;
  client: number;
  role: string;
  /** 'local', 'tls' or 'none'. */
  protection: string;
  session: string;
}

/** Events of the link. The socket's event handlers make all calls. */
export interface LinkEvents {
  opened(hello: Hello): void;
  closed(): void;
  status(delta: Record<string, unknown>, isWhole: boolean): void;
  /** `ageMs`: age of the message when this connection received it. */
  message(message: Message, ageMs: number): void;
  machine(isUp: boolean, client: number, reason: string): void;
  roundTrip(ms: number): void;
  /** Task has not reported for this time; 0: it reports again. */
  silent(seconds: number): void;
  values(values: Record<string, HalValue>): void;
  questions(questions: Question[]): void;
  note(text: string, ageMs: number): void;
}

/** The parts of WebSocket that are used. */
export interface Socket {
  readonly readyState: number;
  onopen: ((event: never) => void) | null;
  onclose: ((event: never) => void) | null;
  onmessage: ((event: { data: string }) => void) | null;
  send(text: string): void;
  close(): void;
}

export interface LinkOptions {
  makeSocket(): Socket;
  now(): number;
  later(act: () => void, ms: number): unknown;
  cancel(timer: unknown): void;
}

const OPEN = 1;
const PING_MS = 1000;
/** After this time without data the connection counts as lost, whatever the socket reports. */
const SILENCE_MS = 3000;
const SHORTEST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 4000;

interface Pending {
  done(outcome: Outcome): void;
  started: ((outcome: Outcome) => void) | undefined;
}

export class Link {
  private socket: Socket | null = null;
  private pending = new Map<number, Pending>();
  private lastId = 0;
  private heardAt = 0;
  private waitMs = SHORTEST_WAIT_MS;
  private pingTimer: unknown = null;
  private isEnded = false;

  constructor(
    private readonly events: LinkEvents,
    private readonly options: LinkOptions,
  ) {}

  open(): void {
    const socket = this.options.makeSocket();
    this.socket = socket;
    this.heardAt = this.options.now();
    socket.onopen = () => {
      this.waitMs = SHORTEST_WAIT_MS;
      this.heardAt = this.options.now();
    };
    socket.onmessage = (event) => {
      if (socket === this.socket) {
        this.heardAt = this.options.now();
        this.take(JSON.parse(event.data) as Record<string, unknown>);
      }
    };
    socket.onclose = () => this.lose(socket);
    this.watch(socket);
  }

  end(): void {
    this.isEnded = true;
    this.options.cancel(this.pingTimer);
    this.socket?.close();
  }

  get isOpen(): boolean {
    return this.socket?.readyState === OPEN;
  }

  /** Time since the last data of the server. [ms] */
  get silence(): number {
    return this.options.now() - this.heardAt;
  }

  /** Sends immediately or fails. Commands are never queued for a later connection, so none arrives late. */
  post(command: Command, onStarted?: (outcome: Outcome) => void): Promise<Outcome> {
    if (!this.isOpen || this.socket === null) {
      return Promise.resolve({ progress: 'FAILED', reason: 'no connection to the machine: nothing was sent' });
    }
    const id = ++this.lastId;
    // The server shortens the lease of a jog by the delay of the text.
    this.socket.send(JSON.stringify({ id, command, sent: this.options.now() }));
    return new Promise((resolve) => this.pending.set(id, { done: resolve, started: onStarted }));
  }

  /** Sets the HAL names whose values are sent on this connection. */
  look(names: readonly string[]): void {
    if (this.isOpen) {
      this.socket?.send(JSON.stringify({ watch: names }));
    }
  }

  private watch(socket: Socket): void {
    this.pingTimer = this.options.later(() => {
      if (socket !== this.socket || this.isEnded) {
        return;
      }
      if (this.silence > SILENCE_MS) {
        socket.close();
        this.lose(socket);
        return;
      }
      if (socket.readyState === OPEN) {
        socket.send(JSON.stringify({ ping: this.options.now() }));
      }
      this.watch(socket);
    }, PING_MS);
  }

  private lose(socket: Socket): void {
    if (socket !== this.socket) {
      return;
    }
    this.socket = null;
    this.options.cancel(this.pingTimer);
    const lost = [...this.pending.values()];
    this.pending.clear();
    for (const one of lost) {
      one.done({ progress: 'FAILED', reason: 'the connection was lost before the outcome was known' });
    }
    this.events.closed();
    if (!this.isEnded) {
      this.options.later(() => this.open(), this.waitMs);
      this.waitMs = Math.min(this.waitMs * 2, LONGEST_WAIT_MS);
    }
  }

  private take(told: Record<string, unknown>): void {
    if ('status' in told) {
      this.events.status(told['status'] as Record<string, unknown>, told['full'] === true);
    } else if ('outcome' in told) {
      this.takeOutcome(told['outcome'] as { id: number; progress: Progress; reason?: string });
    } else if ('message' in told) {
      this.events.message(told['message'] as Message, Number(told['age_ms'] ?? 0));
    } else if ('pong' in told) {
      this.events.roundTrip(this.options.now() - (told['pong'] as number));
    } else if ('hello' in told) {
      this.events.opened(told['hello'] as Hello);
    } else if ('hal' in told) {
      this.events.values(told['hal'] as Record<string, HalValue>);
    } else if ('questions' in told) {
      this.events.questions(told['questions'] as Question[]);
    } else if ('silent' in told) {
      this.events.silent(Number(told['silent']));
    } else if ('note' in told) {
      this.events.note(String(told['note']), Number(told['age_ms'] ?? 0));
    } else if ('machine' in told) {
      this.events.machine(told['machine'] === 'up', Number(told['client'] ?? 0), String(told['reason'] ?? ''));
    }
  }

  private takeOutcome(told: { id: number; progress: Progress; reason?: string }): void {
    const pending = this.pending.get(told.id);
    if (pending === undefined) {
      return;
    }
    const outcome = { progress: told.progress, reason: told.reason ?? '' };
    if (told.progress === 'STARTED') {
      pending.started?.(outcome);
      return;
    }
    this.pending.delete(told.id);
    pending.done(outcome);
  }
}
