// SPDX-License-Identifier: GPL-2.0-or-later
import { expect, it } from 'vitest';
import { ContactCheck, type ContactFacts } from '../src/lib/contact';

const OPEN: ContactFacts = { isOn: false, tool: 9, isSpindleOn: false, isMachineOn: true, isIdle: true };
const CONTACT: ContactFacts = { ...OPEN, isOn: true };

function seenProbe(): ContactCheck {
  const check = new ContactCheck();
  check.update(OPEN, 'probe');
  check.update(CONTACT, 'probe');
  check.update(OPEN, 'probe');
  expect(check.seen).toEqual({ probe: true, setter: false });
  return check;
}

it('counts a contact that begins while it is asked for', () => {
  seenProbe();
});

it.each([
  ['a contact from the start', [[CONTACT, 'probe']]],
  ['a contact that was not requested', [[OPEN, null], [CONTACT, null], [CONTACT, 'probe']]],
  ['a contact as the view opens', [[OPEN, null], [CONTACT, 'probe']]],
  ['a contact in a program', [[OPEN, 'probe'], [{ ...CONTACT, isIdle: false }, 'probe']]],
  ['a contact while the machine is off', [[{ ...OPEN, isMachineOn: false }, 'probe'], [{ ...CONTACT, isMachineOn: false }, 'probe']]],
  ['a contact with a turning spindle', [[{ ...OPEN, isSpindleOn: true }, 'probe'], [{ ...CONTACT, isSpindleOn: true }, 'probe']]],
  ['a contact of the setter', [[OPEN, 'setter'], [CONTACT, 'setter'], [OPEN, 'probe']]],
  ['a contact as the tool changes', [[OPEN, 'probe'], [{ ...CONTACT, tool: 3 }, 'probe']]],
] as [string, [ContactFacts, 'probe' | 'setter' | null][]][])('does not count %s for the probe', (_, updates) => {
  const check = new ContactCheck();
  updates.forEach(([facts, asked]) => check.update(facts, asked));
  expect(check.seen.probe).toBe(false);
});

it.each([
  ['another tool is loaded', { ...OPEN, tool: 3 }],
  ['the spindle turns', { ...OPEN, isSpindleOn: true }],
  ['the machine is switched off', { ...OPEN, isMachineOn: false }],
  ['the machine ends', null],
])('forgets the contact of the probe when %s', (_, facts) => {
  const check = seenProbe();
  check.update(facts, null);
  check.update(OPEN, 'probe');
  expect(check.seen.probe).toBe(false);
});

it('keeps the setter for each tool, and forgets it with the machine', () => {
  const check = new ContactCheck();
  check.update(OPEN, 'setter');
  check.update(CONTACT, 'setter');
  check.update({ ...OPEN, tool: 3 }, 'setter');
  check.update({ ...OPEN, tool: 3, isSpindleOn: true }, null);
  expect(check.seen).toEqual({ probe: false, setter: true });
  check.update(null, null);
  expect(check.seen.setter).toBe(false);
});
