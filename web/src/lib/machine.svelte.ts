// SPDX-License-Identifier: GPL-2.0-or-later
// The machine as this page sees it: one socket, one status, the messages, and their combination.
import { Dismissed } from './dismissed';
import type { View } from './gates';
import { record } from './history.svelte';
import { checkLogin } from './login.svelte';
import { readKept } from './prefs.svelte';
import { Link, type Command, type HalValue, type Message, type Outcome, type Question, type Socket } from './link';
import { mergeDelta, type MachineFacts, type MachineStatus } from './status';

export interface Notice {
  /** Unique in the page, increasing. */
  id: number;
  kind: Message['kind'] | 'LOCAL';
  text: string;
  at: Date;
  /** Task's number of the message; 0: none. */
  number: number;
  /** Identifies the start of the machine that numbers the messages; for a note, the start of the server. */
  run: string;
  isRead: boolean;
}

const MOST_NOTICES = 300;
/** Time within which an outcome and a message with the same text are shown only once. */
const SAME_MS = 2000;
const WAIT_FOR_MESSAGE_MS = 300;
const STALE_MS = 1000;

interface Known {
  /** The program with unsaved changes in the editor of this page. */
  unsaved: string | null;
  isConnected: boolean;
  hasConnected: boolean;
  isMachineUp: boolean;
  goneReason: string;
  client: number;
  role: string;
  protection: string;
  version: string;
  session: string;
  status: MachineStatus | null;
  facts: MachineFacts | null;
  roundTripMs: number | null;
  /** Age of the status, if it is too old to be shown as current. [s] */
  staleSeconds: number | null;
  /** Time for which task has not reported to the server. */
  silentSeconds: number | null;
}

export const machine = $state<Known>({
  unsaved: null,
  isConnected: false,
  hasConnected: false,
  isMachineUp: false,
  goneReason: '',
  client: 0,
  role: 'view',
  protection: '',
  version: '',
  session: '',
  status: null,
  facts: null,
  roundTripMs: null,
  staleSeconds: null,
  silentSeconds: null,
});

export const notices = $state<{ list: Notice[] }>({ list: [] });

let lastNotice = 0;
let statusAt = 0;
let lastMessage = 0;
let lastRun = '';
const onLost: (() => void)[] = [];

/** `act` is called when the connection or the machine is lost. */
export function whenLost(act: () => void): void {
  onLost.push(act);
}

const onStatus: (() => void)[] = [];

/** Waits up to `ms` for a new status for which `isTrue` returns true. */
export async function untilStatus(isTrue: (status: MachineStatus) => boolean, ms = 2000): Promise<void> {
  const deadline = performance.now() + ms;
  do {
    await new Promise<void>((done) => {
      const timer = setTimeout(done, ms);
      onStatus.push(() => {
        clearTimeout(timer);
        done();
      });
    });
  } while (performance.now() < deadline && !(machine.status !== null && isTrue(machine.status)));
}

export function view(): View {
  return machine;
}

function storage(): Storage | null {
  try {
    return localStorage;
  } catch {
    return null; // a browser without storage
  }
}

const dismissed = new Dismissed(storage());

/** Marks all messages shown now as read, also after a reload of this page. */
export function dismissAll(): void {
  const fresh = notices.list.filter((one) => !one.isRead);
  fresh.forEach((one) => (one.isRead = true));
  dismissed.add(
    fresh.filter((one) => one.kind !== 'LOCAL').map((one) => ({ ...one, at: one.at.getTime() })),
  );
}

/** Adds a message that was received `ageMs` ago. A screen that connects also receives earlier messages from the server. */
export function tell(kind: Notice['kind'], text: string, ageMs = 0, number = 0, run = machine.session): void {
  const at = new Date(Date.now() - ageMs);
  const isKnown = notices.list.some((one) => one.text === text && Math.abs(at.getTime() - one.at.getTime()) < SAME_MS);
  if (isKnown || text === '') {
    return;
  }
  const isRead = kind !== 'LOCAL' && dismissed.has({ kind, text, at: at.getTime(), number, run });
  notices.list.unshift({ id: ++lastNotice, kind, text, at, number, run, isRead });
  if (notices.list.length > MOST_NOTICES) {
    notices.list.length = MOST_NOTICES;
  }
}

/** Adds a message of this page itself. */
export function tellLocally(text: string): void {
  tell('LOCAL', text);
}

async function fetchFacts(): Promise<void> {
  const answer = await fetch('/api/machine');
  if (answer.ok) {
    machine.facts = (await answer.json()) as MachineFacts;
    document.title = machine.facts.title || machine.facts.name;
    if (machine.facts.has_icon) {
      document.querySelector('link[rel="icon"]')?.setAttribute('href', '/api/icon');
    }
    await readKept(machine.facts.keeps_preferences, machine.facts.keeps_mdi_history);
  } else {
    tell('LOCAL', `GET /api/machine: ${answer.status}`);
  }
}

function lose(): void {
  for (const act of onLost) {
    act();
  }
}

const link = new Link(
  {
    opened(hello) {
      machine.isConnected = true;
      machine.hasConnected = true;
      machine.client = hello.client;
      machine.role = hello.role;
      machine.protection = hello.protection;
      machine.version = hello.version;
      machine.session = hello.session;
      machine.isMachineUp = hello.client !== 0;
      questions.list = [];
      link.look(watched);
      fetchFacts().catch((error: unknown) => tell('LOCAL', String(error)));
    },
    closed() {
      machine.isConnected = false;
      machine.isMachineUp = false;
      machine.silentSeconds = null;
      machine.roundTripMs = null;
      lose();
      void checkLogin();
    },
    status(delta, isWhole) {
      statusAt = performance.now();
      machine.staleSeconds = machine.silentSeconds = null;
      if (isWhole || machine.status === null) {
        machine.status = delta as unknown as MachineStatus;
      } else {
        mergeDelta(machine.status as unknown as Record<string, unknown>, delta);
      }
      onStatus.splice(0).forEach((act) => act());
      const now = machine.status;
      if (now !== null) {
        record(now.time_ns * 1e-9, now.trajectory.current_velocity, now.joints.slice(0, now.trajectory.num_joints).map((one) => one.ferror));
      }
    },
    message(message, ageMs) {
      if (message.run !== lastRun || message.number > lastMessage) {
        lastRun = message.run;
        lastMessage = message.number;
        tell(message.kind, message.text, ageMs, message.number, message.run);
      }
    },
    machine(isUp, client, reason) {
      machine.isMachineUp = isUp;
      machine.client = client;
      machine.goneReason = reason;
      if (!isUp) {
        machine.status = null;
        lose();
      }
    },
    questions(asked) {
      questions.list = asked;
    },
    note(text, ageMs) {
      tell('OPERATOR_TEXT', text, ageMs);
    },
    values(values) {
      Object.assign(halValues, values);
    },
    silent(seconds) {
      machine.silentSeconds = seconds > 0 ? seconds : null;
    },
    roundTrip(ms) {
      machine.roundTripMs = ms;
    },
  },
  {
    makeSocket: () => {
      const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
      return new WebSocket(`${scheme}://${location.host}/api/socket`) as unknown as Socket;
    },
    now: () => performance.now(),
    later: (act, ms) => setTimeout(act, ms),
    cancel: (timer) => clearTimeout(timer as number),
  },
);

/** Questions of HAL. */
export const questions = $state<{ list: Question[] }>({ list: [] });

export async function answerQuestion(question: Question, yes: boolean): Promise<void> {
  const answer = await fetch('/api/questions', { method: 'POST', body: JSON.stringify({ id: question.id, number: question.number, yes }) });
  if (!answer.ok) {
    tell('LOCAL', ((await answer.json()) as { error?: string }).error ?? `POST /api/questions: ${answer.status}`);
  }
}

/** Watched HAL values, as last received. */
export const halValues = $state<Record<string, HalValue>>({});
let watched: string[] = [];

/** From now on `halValues` contains exactly these names. */
export function watchHal(names: readonly string[]): void {
  watched = [...names];
  for (const name of Object.keys(halValues)) {
    delete halValues[name];
  }
  link.look(watched);
}

export function connect(): void {
  link.open();
  setInterval(() => {
    const age = performance.now() - statusAt;
    const isStale = machine.isMachineUp && machine.status !== null && age > STALE_MS;
    machine.staleSeconds = isStale ? Math.floor(age / 1000) : null;
  }, 500);
}

/** The message without the severity between position and text. */
function essence(text: string): string {
  return text.replace(': error: ', ': ').split('\n')[0] ?? '';
}

/** Task reports most rejections also as a message, which may arrive slightly later. */
function tellUnlessMessage(reason: string): void {
  setTimeout(() => {
    const since = Date.now() - SAME_MS;
    const isTold = notices.list.some((one) => one.at.getTime() > since && essence(one.text).includes(essence(reason)));
    if (!isTold) {
      tell('LOCAL', reason);
    }
  }, WAIT_FOR_MESSAGE_MS);
}

/** Sends a command; a rejection or failure is also shown to the operator. */
export async function send(command: Command, onStarted?: (outcome: Outcome) => void): Promise<Outcome> {
  const outcome = await link.post(command, onStarted);
  if (outcome.progress === 'REFUSED' || outcome.progress === 'FAILED') {
    tellUnlessMessage(outcome.reason);
  }
  return outcome;
}

/** As send(), but the caller reports failures itself. */
export function sendQuietly(command: Command): Promise<Outcome> {
  return link.post(command);
}
