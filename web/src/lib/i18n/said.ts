// SPDX-License-Identifier: GPL-2.0-or-later
// Translates texts of the machine, which are English: a text is found by the fixed parts of the message. The
// rules are those of src/base/language/catalogue; po/cases.json tests both.

interface Pattern {
  pieces: string[]; // fixed parts of the key, between the values
  letters: number; // letters of all pieces
  isName: boolean; // a single word ("joint {}"): the value is a name, too
  translation: string;
}

const MAX_DEPTH = 5; // maximum nesting of texts
const MAX_LOOKUPS = 2000; // Limit for one message, because a message of unknown words with many colons has too many parts.
const countWords = (pieces: string[]): number => pieces.reduce((sum, piece) => sum + (piece.match(/[A-Za-z]{2,}/g) ?? []).length, 0);
// A value of one word is treated as a name or a number, because a signal may be called "error".
const hasSeveralWords = (text: string): boolean => text.includes(' ') && (text.match(/[A-Za-z]/g) ?? []).length > 2;

/** The texts between the pieces in `text`; null if `text` does not consist of the pieces in this order. */
function valuesBetween(pieces: string[], text: string): string[] | null {
  const [first = '', ...others] = pieces;
  if (!text.startsWith(first)) {
    return null;
  }
  let rest = text.slice(first.length);
  const values: string[] = [];
  for (const [i, piece] of others.entries()) {
    const isLast = i + 1 === others.length;
    const at = isLast ? (rest.endsWith(piece) ? rest.length - piece.length : -1) : rest.indexOf(piece);
    if (at < 0) {
      return null;
    }
    values.push(rest.slice(0, at));
    rest = rest.slice(at + piece.length);
  }
  return values;
}

/** The texts of one language. */
export class Texts {
  private readonly whole = new Map<string, string>();
  private readonly patterns: Pattern[] = [];
  private left = MAX_LOOKUPS;

  constructor(entries: Record<string, string>) {
    for (const [key, translation] of Object.entries(entries)) {
      const pieces = key.split('{}');
      if (pieces.length === 1) {
        this.whole.set(key, translation);
      } else {
        this.patterns.push({ pieces, letters: pieces.join('').length, isName: countWords(pieces) < 2, translation });
      }
    }
    this.patterns.sort((a, b) => b.letters - a.letters);
  }

  /** A message as shown; unknown parts remain English. */
  shown(english: string): string {
    this.left = MAX_LOOKUPS;
    return this.find(english, 0) ?? (english.includes('\n') ? english.split('\n').map((line) => this.line(line)).join('\n') : this.line(english));
  }

  private line(text: string): string {
    if (text.startsWith('  ')) {
      const caller = text.startsWith('  called from ') ? this.find(text.slice(2), 0) : null;
      return caller === null ? text : `  ${caller}`; // lines of a program are not translated
    }
    this.left = MAX_LOOKUPS;
    return this.composed(text, 0) ?? text;
  }

  private find(text: string, depth: number): string | null {
    this.left -= 1;
    if (this.left < 0) {
      return null;
    }
    const whole = this.whole.get(text);
    if (whole !== undefined) {
      return whole;
    }
    for (const pattern of this.patterns) {
      const values = valuesBetween(pattern.pieces, text);
      if (values !== null && this.isFitting(pattern, values, depth)) {
        return this.filled(pattern, values, depth + 1);
      }
    }
    return null;
  }

  private isFitting(pattern: Pattern, values: string[], depth: number): boolean {
    if (pattern.pieces[0] === '' && values[0]?.includes(': ')) {
      // a position, type or sentence that ends with a colon at the beginning is a separate part, not a value
      return false;
    }
    return !pattern.isName || values.every((value) => !value.includes(' ') || (depth < MAX_DEPTH && this.composed(value, depth + 1) !== null));
  }

  private filled(pattern: Pattern, values: string[], depth: number): string {
    let next = 0;
    return pattern.translation.replace(/\{(\d?)\}/g, (_place, which: string) => {
      const value = values[which === '' ? next++ : Number(which)] ?? '';
      return depth < MAX_DEPTH && hasSeveralWords(value) ? (this.composed(value, depth) ?? value) : value;
    });
  }

  private composed(text: string, depth: number): string | null {
    const found = this.find(text, depth);
    if (found !== null || depth >= MAX_DEPTH || this.left <= 0) {
      return found;
    }
    return this.withHint(text, depth) ?? this.inParts(text, depth) ?? this.withEnding(text, depth);
  }

  /** "MESSAGE (HINT)". */
  private withHint(text: string, depth: number): string | null {
    for (let at = text.endsWith(')') ? text.indexOf(' (') : -1; at >= 0; at = text.indexOf(' (', at + 1)) {
      const head = text.slice(0, at), hint = text.slice(at + 2, -1);
      const said = this.composed(head, depth + 1), advised = this.composed(hint, depth + 1);
      if (said !== null || advised !== null) {
        return `${said ?? head} (${advised ?? hint})`;
      }
    }
    return null;
  }

  /** "PLACE: MESSAGE", "MESSAGE; MESSAGE". */
  private inParts(text: string, depth: number): string | null {
    for (const between of [': ', '; ']) {
      for (let at = text.indexOf(between); at >= 0; at = text.indexOf(between, at + 1)) {
        const head = text.slice(0, at), rest = text.slice(at + between.length);
        const said = this.find(head, depth + 1), more = this.composed(rest, depth + 1);
        if (said !== null || more !== null) {
          return (said ?? head) + between + (more ?? rest);
        }
      }
    }
    return null;
  }

  /** A name with a suffix; the key of the suffix begins with a blank or a colon. */
  private withEnding(text: string, depth: number): string | null {
    for (let at = 1; at < text.length; ++at) {
      if (text[at] !== ' ' && text[at] !== ':') {
        continue;
      }
      this.left -= 1;
      if (this.left < 0) {
        return null;
      }
      const ending = text.slice(at), whole = this.whole.get(ending);
      if (whole !== undefined) {
        return text.slice(0, at) + whole;
      }
      for (const pattern of this.patterns) {
        const values = pattern.pieces[0]?.startsWith(ending.charAt(0)) ? valuesBetween(pattern.pieces, ending) : null;
        if (values !== null) {
          return text.slice(0, at) + this.filled(pattern, values, depth + 1);
        }
      }
    }
    return null;
  }
}
