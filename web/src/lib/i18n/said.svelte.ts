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

/** A text of the machine in the operator's language; in English until the texts are loaded. */
export function said(english: string): string {
  const language = prefs.language;
  if (!asked.has(language)) {
    asked.add(language);
    fetchTexts(language).catch(() => asked.delete(language)); // requested again with the next message
  }
  return (read.texts[language] ?? NONE).shown(english);
}

/** The text of a message. Texts of programs and of this page are already in their language. */
export function noticeText(kind: string, text: string): string {
  return kind === 'OPERATOR_DISPLAY' ? text : said(text);
}
