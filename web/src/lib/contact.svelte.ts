// SPDX-License-Identifier: GPL-2.0-or-later
// The check of probe and setter on this screen.
import { ContactCheck, contactFacts, type Sensor } from './contact';
import type { Gate } from './gates';
import { inputs } from './inputs.svelte';
import { machine } from './machine.svelte';

const check = new ContactCheck();

export const contact = $state<{ asked: Sensor | null; seen: Record<Sensor, boolean> }>({ asked: null, seen: { probe: false, setter: false } });

/** Tracks events that invalidate a contact. Each view calls it in an effect, so that no event is missed. */
export function followContact(): void {
  const { status } = machine;
  check.update(machine.isMachineUp && status !== null ? contactFacts(status) : null, contact.asked);
  Object.assign(contact.seen, check.seen);
}

/** Conditions for a cycle with `sensor` in addition to those of an MDI line. */
export function canProbe(sensor: Sensor): Gate {
  const { status } = machine;
  if (inputs.known?.probe !== true) {
    return { key: inputs.known === null ? 'gate.probe_unknown' : 'gate.probe_missing' };
  }
  if (status === null || status.spindles.some((one) => one.is_on)) {
    return { key: 'gate.probe_spindle' };
  }
  if (status.probe.on) {
    return { key: 'gate.probe_contact' };
  }
  return contact.seen[sensor] ? null : { key: sensor === 'probe' ? 'gate.probe_unseen' : 'gate.setter_unseen' };
}
