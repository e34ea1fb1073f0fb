// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that a shop offers to the machine, by docs/reference/api.md.

export interface Offer {
  id: string;
  name: string;
  from: string;
  note: string;
  parts: number;
  bytes: number;
  files: string[];
  received_ms: number;
  state: 'received' | 'accepted' | 'declined' | 'withdrawn' | 'rejected';
  job: boolean;
}

export interface OfferedFile {
  name: string;
  text: string;
}

export type Decision = { decision: 'accept'; replace: boolean } | { decision: 'decline'; reason: string } | { decision: 'finish' };

/** Files that an acceptance would replace; null if the decision was carried out. */
export type Outcome = string[] | null;

interface Told {
  error?: string;
  replaces?: string[];
}

async function fail(answer: Response): Promise<never> {
  const told = (await answer.json().catch(() => null)) as Told | null;
  throw new Error(told?.error ?? `${answer.url}: ${answer.status}`);
}

export async function listOffers(): Promise<Offer[]> {
  const answer = await fetch('/api/offers');
  return answer.ok ? ((await answer.json()) as { offers: Offer[] }).offers : fail(answer);
}

export async function readOffer(id: string): Promise<OfferedFile[]> {
  const answer = await fetch(`/api/offers/${id}`);
  return answer.ok ? ((await answer.json()) as { files: OfferedFile[] }).files : fail(answer);
}

export async function decide(id: string, by: string, decision: Decision): Promise<Outcome> {
  const answer = await fetch(`/api/offers/${id}`, { method: 'POST', body: JSON.stringify({ ...decision, by }) });
  if (answer.ok) {
    return null;
  }
  const told = (await answer.json().catch(() => null)) as Told | null;
  if (told?.replaces !== undefined) {
    return told.replaces;
  }
  throw new Error(told?.error ?? `POST /api/offers: ${answer.status}`);
}

/** Offers that wait, then jobs. */
export function isShown(offer: Offer): boolean {
  return offer.state === 'received' || offer.job;
}
