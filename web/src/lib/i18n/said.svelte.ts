// SPDX-License-Identifier: GPL-2.0-or-later
import { prefs } from '../prefs.svelte';
import { Texts } from './said';

const NONE = new Texts({});
const read = $state.raw<{ texts: Record<string, Texts> }>({ texts: {} });
const asked = new Set<string>(['en']);

async function fetchTexts(language: string): Promise<void> {
  const answer = await fetch(`/texts/${language}.json`);
  if (answer.ok) {
    read.texts = { ...read.texts, [language]: new Texts((await answer.json()) as Record<string, string>) };
  }
}

/** What the machine says, in the operator's language; English until its texts are here. */
export function said(english: string): string {
  const language = prefs.language;
  if (!asked.has(language)) {
    asked.add(language);
    fetchTexts(language).catch(() => asked.delete(language)); // asked for again with the next message
  }
  return (read.texts[language] ?? NONE).shown(english);
}

/** A message's text: what programs say, and this page itself, is in its language already. */
export function noticeText(kind: string, text: string): string {
  return kind === 'OPERATOR_DISPLAY' ? text : said(text);
}
