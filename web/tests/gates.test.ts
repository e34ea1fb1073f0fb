// SPDX-License-Identifier: GPL-2.0-or-later
// Tests each gate in each situation with the table of the page states.md, which is generated from task's
// table.
import { fileURLToPath } from 'node:url';
import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import * as gates from '../src/lib/gates';
import type { MachineFacts, MachineStatus, TaskStatus } from '../src/lib/status';

const FACTS = { axes: 'XYZ', joints: 3, is_homing_forced: true } as MachineFacts;

interface Situation {
  task: Partial<TaskStatus>;
  approach?: number;
}

const ON = { state: 'ON' } as const;
const SITUATIONS: Record<string, Situation> = {
  estop: { task: { state: 'ESTOP' } },
  off: { task: { state: 'ESTOP_RESET' } },
  manual: { task: { ...ON } },
  auto: { task: { ...ON, mode: 'AUTO' } },
  running: { task: { ...ON, mode: 'AUTO', interp_state: 'READING' } },
  held: { task: { ...ON, mode: 'AUTO', interp_state: 'PAUSED', is_paused: true } },
  proposed: { task: { ...ON, mode: 'AUTO', interp_state: 'PAUSED', is_paused: true }, approach: 4 },
  away: { task: { ...ON, mode: 'AUTO', interp_state: 'PAUSED', is_paused: true, is_away: true } },
  mdi: { task: { ...ON, mode: 'MDI' } },
  line: { task: { ...ON, mode: 'MDI', interp_state: 'READING' } },
  'line held': { task: { ...ON, mode: 'MDI', interp_state: 'PAUSED', is_paused: true } },
};

function view(one: Situation): gates.View {
  const task = { state: 'ESTOP', mode: 'MANUAL', interp_state: 'IDLE', is_away: false, is_paused: false, program: '/p.ngc', ...one.task };
  const status = {
    task,
    approach: { number: one.approach ?? 0 },
    trajectory: { all_homed: true, is_homing: false, in_position: true },
    operation: { holder: 0 },
    overrides: { feed_enabled: true },
    spindles: [{ override_enabled: true }],
  } as unknown as MachineStatus;
  return { isConnected: true, isMachineUp: true, role: 'operate', client: 5, status, facts: FACTS, unsaved: null };
}

/** Rows and columns of the table "Commands in situations". */
function readTable(): Map<string, Map<string, boolean>> {
  const build = process.env['MW_BUILD'] ?? fileURLToPath(new URL('../../build/release', import.meta.url));
  const page = readFileSync(`${build}/share/doc/states.md`, 'utf8');
  const lines = (page.split('## Commands in situations')[1] ?? '').split('\n').filter((line) => line.startsWith('|'));
  const cells = (line: string): string[] => line.split('|').slice(1, -1).map((cell) => cell.trim());
  const columns = cells(lines[0] ?? '').slice(1);
  return new Map(
    lines.slice(2, 24).map((line) => {
      const [name, ...rest] = cells(line);
      return [name ?? '', new Map(columns.map((column, i) => [column, rest[i] === 'yes']))];
    }),
  );
}

const table = readTable();

/** The screen changes the mode by itself while nothing runs. So it may do what task permits in the new mode. */
const ANY_MODE: Record<string, string[]> = { manual: ['manual', 'auto', 'mdi'], auto: ['manual', 'auto', 'mdi'], mdi: ['manual', 'auto', 'mdi'] };

describe.each([
  ['run', gates.canRun],
  ['step', gates.canStep],
  ['resume', gates.canResume],
  ['line', gates.canMdi],
  ['jog', gates.canJog],
  ['joints', gates.canHome],
  ['energise', gates.canEnergise],
  ['program file', gates.canOpen],
  ['release', gates.canRelease],
] as const)('%s', (row, gate) => {
  it.each(Object.keys(SITUATIONS))('in situation %s', (name) => {
    const situation = SITUATIONS[name] as Situation;
    const mayTask = (ANY_MODE[name] ?? [name]).some((one) => table.get(row)?.get(one) === true);
    const isOpen = gate(view(situation)) === null;
    if (isOpen) {
      expect(mayTask, 'the screen offers a command that task rejects').toBe(true);
    } else if (mayTask) {
      // Task accepts these commands and no others; the screen is stricter.
      expect([
        'resume proposed', // an approach is confirmed in its own dialog
        // Task accepts resume without effect when nothing is paused; the screen offers it only when it has an
        // effect.
        'resume manual', 'resume auto', 'resume running', 'resume mdi', 'resume line',
        'resume away', 'line line held', 'program file estop', 'program file off', 'release away',
      ]).toContain(`${row} ${name}`);
    }
  });
});

describe('what every command needs', () => {
  const open = view(SITUATIONS['manual'] as Situation);
  it.each([
    ['a connection', { ...open, isConnected: false }, 'gate.connection'],
    ['a machine', { ...open, isMachineUp: false }, 'gate.machine'],
    ['a role', { ...open, role: 'view' }, 'gate.role'],
  ] as const)('%s', (_what, one, key) => {
    for (const gate of [gates.canJog, gates.canHome, gates.canRun, gates.canMdi, gates.canEnergise, gates.canReset]) {
      expect(gate(one)?.key).toBe(key);
    }
  });
  it('the right to operate of another client', () => {
    const status = structuredClone(open.status) as MachineStatus;
    status.operation.holder = 3;
    expect(gates.canJog({ ...open, status })).toEqual({ key: 'gate.holder', values: { client: 3 } });
    status.operation.holder = 5;
    expect(gates.canJog({ ...open, status })).toBeNull();
  });
  it('homed joints for programs, where the machine wants them', () => {
    const status = structuredClone(open.status) as MachineStatus;
    status.trajectory.all_homed = false;
    expect(gates.canRun({ ...open, status })?.key).toBe('gate.homed');
    expect(gates.canJog({ ...open, status })).toBeNull();
    expect(gates.canRun({ ...open, status, facts: { ...FACTS, is_homing_forced: false } })).toBeNull();
  });
});

describe('changes in the editor that are not saved', () => {
  const facts = { ...FACTS, program_prefix: '/programs' } as MachineFacts;
  const withText = (name: string, unsaved: string | null): gates.View => {
    const one = view(SITUATIONS[name] as Situation);
    (one.status as MachineStatus).task.program = '/programs/p.ngc';
    return { ...one, facts, unsaved };
  };
  it('are not run: the file has another text', () => {
    for (const start of [gates.canRun, gates.canStep]) {
      expect(start(withText('manual', null))).toBeNull();
      expect(start(withText('manual', 'p.ngc'))?.key).toBe('gate.unsaved');
      expect(start(withText('manual', 'other.ngc'))).toBeNull();
    }
  });
  it('do not hold a program that already runs', () => {
    expect(gates.canStep(withText('held', 'p.ngc'))).toBeNull();
    expect(gates.canResume(withText('held', 'p.ngc'))).toBeNull();
  });
});
