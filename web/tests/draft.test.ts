// SPDX-License-Identifier: GPL-2.0-or-later
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import * as actions from '../src/lib/actions';
import { discardDraft, draft, draftOf, keepDraft, saveDraft } from '../src/lib/draft.svelte';
import { confirmStart, forgetStart, keyStart, startByKey } from '../src/lib/keystart.svelte';
import { machine } from '../src/lib/machine.svelte';
import type { MachineFacts, MachineStatus } from '../src/lib/status';

vi.mock('../src/lib/actions', () => ({ openProgram: vi.fn(), run: vi.fn(), resume: vi.fn(), step: vi.fn() }));
const openProgram = vi.mocked(actions.openProgram);
const files = vi.fn(async () => Promise.resolve(new Response('')));

function program(state: 'IDLE' | 'PAUSED'): void {
  machine.facts = { program_prefix: '/programs' } as MachineFacts;
  machine.status = { task: { program: '/programs/p.ngc', interp_state: state } } as MachineStatus;
}

beforeEach(() => {
  vi.clearAllMocks();
  vi.stubGlobal('fetch', files);
  openProgram.mockResolvedValue({ progress: 'DONE', reason: '' });
  program('IDLE');
  discardDraft();
  forgetStart();
});
afterEach(() => vi.unstubAllGlobals());

describe('changes that are not saved', () => {
  it('are kept by the page until they are saved or discarded', () => {
    keepDraft('p.ngc', 'G0 X1', 'G0 X0');
    expect(draftOf('p.ngc')).toBe('G0 X1');
    expect(draftOf('q.ngc')).toBeNull();
    expect(machine.unsaved).toBe('p.ngc');
    keepDraft('q.ngc', 'M2', 'M2'); // another program is shown, without changes
    expect(draftOf('p.ngc')).toBe('G0 X1');
    keepDraft('p.ngc', 'G0 X0', 'G0 X0'); // undone
    expect(machine.unsaved).toBeNull();
  });
  it('are saved when task has opened the new text, not before', async () => {
    keepDraft('p.ngc', 'G0 X1', 'G0 X0');
    openProgram.mockResolvedValueOnce({ progress: 'REFUSED', reason: 'a program is running' });
    await saveDraft();
    expect(machine.unsaved).toBe('p.ngc');
    await saveDraft();
    expect(machine.unsaved).toBeNull();
    expect(files).toHaveBeenCalledTimes(2);
  });
  it('of another program than the open one are written, and open nothing', async () => {
    keepDraft('q.ngc', 'G0 X1', 'G0 X0');
    await saveDraft();
    expect(draft.now).toBeNull();
    expect(openProgram).not.toHaveBeenCalled();
  });
  it('stay where they were typed while the text was written', async () => {
    keepDraft('p.ngc', 'G0 X1', 'G0 X0');
    openProgram.mockImplementationOnce(async () => {
      keepDraft('p.ngc', 'G0 X12', 'G0 X0');
      return Promise.resolve({ progress: 'DONE', reason: '' });
    });
    await saveDraft();
    expect(draftOf('p.ngc')).toBe('G0 X12');
  });
});

describe('a key that moves the machine by its program', () => {
  it.each(['run', 'resume', 'step'] as const)('%s acts after a confirmation', (start) => {
    startByKey(start);
    expect(actions[start]).not.toHaveBeenCalled();
    expect(keyStart.asked).toBe(start);
    confirmStart();
    expect(actions[start]).toHaveBeenCalledOnce();
    confirmStart();
    expect(actions[start]).toHaveBeenCalledOnce();
  });
  it('steps on without one in the program whose step was confirmed, and in no other', () => {
    startByKey('step');
    confirmStart();
    startByKey('step'); // the program has not started: ask again
    expect(actions.step).toHaveBeenCalledOnce();
    program('PAUSED');
    startByKey('step');
    expect(actions.step).toHaveBeenCalledTimes(2);
    startByKey('resume');
    confirmStart();
    startByKey('step');
    expect(actions.step).toHaveBeenCalledTimes(2);
    forgetStart();
    startByKey('step');
    expect(keyStart.asked).toBe('step');
  });
});
