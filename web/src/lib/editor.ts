// SPDX-License-Identifier: GPL-2.0-or-later
// The text of a program: numbered lines, colours for words of G-code, errors at their position, the running
// line.
import { defaultKeymap, history, historyKeymap } from '@codemirror/commands';
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { lintGutter, setDiagnostics, type Diagnostic } from '@codemirror/lint';
import { highlightSelectionMatches, searchKeymap } from '@codemirror/search';
import { Compartment, EditorState, StateEffect, StateField } from '@codemirror/state';
import { Decoration, drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers, type DecorationSet } from '@codemirror/view';
import { tags } from '@lezer/highlight';

export interface Fault {
  line: number;
  column: number;
  text: string;
}

/** Parses "path:line:column: text", the form of errors of programs. */
export function parseFault(text: string): Fault | null {
  const match = /^(?:.*?):(\d+):(\d+): (?:error: )?([\s\S]*)$/.exec(text);
  return match === null ? null : { line: Number(match[1]), column: Number(match[2]), text: match[3] ?? '' };
}

const gcode = StreamLanguage.define<{ isComment: boolean }>({
  startState: () => ({ isComment: false }),
  token(stream) {
    if (stream.match(/^\([^)]*\)?/) || stream.match(/^;.*/)) {
      return 'comment';
    }
    if (stream.match(/^[oO](<[^>]*>|\d+)\s*\w+/)) {
      return 'keyword';
    }
    if (stream.match(/^[#](<[^>]*>|\d+)/)) {
      return 'variableName';
    }
    if (stream.match(/^[gGmM]\s*[\d.]+/)) {
      return 'keyword';
    }
    if (stream.match(/^[-+]?[\d.]+/)) {
      return 'number';
    }
    if (stream.match(/^[a-zA-Z]/)) {
      return 'typeName';
    }
    stream.next();
    return null;
  },
});

const COLORS = HighlightStyle.define([
  { tag: tags.comment, color: 'var(--soft)', fontStyle: 'italic' },
  { tag: tags.keyword, color: 'var(--accent)', fontWeight: '600' },
  { tag: tags.variableName, color: 'var(--warn)' },
  { tag: tags.number, color: 'var(--text)' },
  { tag: tags.typeName, color: 'var(--good)', fontWeight: '600' },
]);

const THEME = EditorView.theme({
  '&': { height: '100%', fontSize: '15px', backgroundColor: 'var(--panel)', color: 'var(--text)' },
  '.cm-scroller': { fontFamily: "ui-monospace, 'DejaVu Sans Mono', monospace", lineHeight: '1.5' },
  '.cm-gutters': { backgroundColor: 'var(--raised)', color: 'var(--soft)', border: 'none' },
  '.cm-activeLine, .cm-activeLineGutter': { backgroundColor: 'color-mix(in srgb, var(--accent) 12%, transparent)' },
  '.cm-running': { backgroundColor: 'var(--good-ground)', boxShadow: 'inset 4px 0 0 var(--good)' },
  '.cm-cursor': { borderLeftColor: 'var(--text)' },
  '&.cm-focused .cm-selectionBackground, .cm-selectionBackground': { backgroundColor: 'var(--accent-ground) !important' },
});

const setRunning = StateEffect.define<number>();
const running = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(marks, change) {
    for (const effect of change.effects) {
      if (effect.is(setRunning)) {
        const isThere = effect.value >= 1 && effect.value <= change.state.doc.lines;
        return isThere
          ? Decoration.set([Decoration.line({ class: 'cm-running' }).range(change.state.doc.line(effect.value).from)])
          : Decoration.none;
      }
    }
    return marks.map(change.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

export class ProgramEditor {
  private readonly view: EditorView;
  private readonly writable = new Compartment();
  private runningLine = 0;

  constructor(parent: HTMLElement, label: string, changed: () => void, moved: (line: number) => void) {
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        extensions: [
          lineNumbers(), history(), drawSelection(), highlightActiveLine(), highlightSelectionMatches(), lintGutter(), gcode,
          syntaxHighlighting(COLORS), THEME, running, keymap.of([...defaultKeymap, ...historyKeymap, ...searchKeymap]),
          this.writable.of(EditorState.readOnly.of(false)),
          EditorView.contentAttributes.of({ 'aria-label': label, tabindex: '0' }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) {
              changed();
            }
            if (update.selectionSet || update.docChanged) {
              moved(update.state.doc.lineAt(update.state.selection.main.head).number);
            }
          }),
        ],
      }),
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /**
   * The cursor remains at its position if the text is unchanged, because a program is read again when offsets
   * change.
   */
  show(text: string): void {
    if (text === this.text) {
      return;
    }
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, selection: { anchor: 0 } });
  }

  setWritable(isWritable: boolean): void {
    this.view.dispatch({ effects: this.writable.reconfigure(EditorState.readOnly.of(!isWritable)) });
  }

  showFaults(faults: Fault[]): void {
    const { doc } = this.view.state;
    const diagnostics: Diagnostic[] = faults.map((fault) => {
      const line = doc.line(Math.min(Math.max(fault.line, 1), doc.lines));
      const from = Math.min(line.from + Math.max(fault.column - 1, 0), line.to);
      return { from, to: Math.max(from, line.to), severity: 'error', message: fault.text };
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  /** Moves the cursor to a line and scrolls to it. */
  goTo(line: number): void {
    const { doc } = this.view.state;
    const at = doc.line(Math.min(Math.max(line, 1), doc.lines)).from;
    this.view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: 'center' }) });
    this.view.focus();
  }

  /** 0: none. Scrolls to the line when it changes. */
  showRunning(line: number): void {
    if (line === this.runningLine) {
      return;
    }
    this.runningLine = line;
    const isThere = line >= 1 && line <= this.view.state.doc.lines;
    this.view.dispatch({
      effects: [
        setRunning.of(line),
        ...(isThere ? [EditorView.scrollIntoView(this.view.state.doc.line(line).from, { y: 'center' })] : []),
      ],
    });
  }

  dispose(): void {
    this.view.destroy();
  }
}
