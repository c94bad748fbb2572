// The editor of a TOML text: colours, and mistakes at their lines.

import { StreamLanguage, HighlightStyle, syntaxHighlighting } from '@codemirror/language';
import { toml } from '@codemirror/legacy-modes/mode/toml';
import { lintGutter, setDiagnostics } from '@codemirror/lint';
import { autocompletion } from '@codemirror/autocomplete';
import { EditorView } from '@codemirror/view';
import { tags } from '@lezer/highlight';
import { basicSetup } from 'codemirror';

const colours = HighlightStyle.define([
  { tag: tags.comment, color: 'var(--soft)', fontStyle: 'italic' },
  { tag: tags.propertyName, color: 'var(--link)' },
  { tag: tags.string, color: 'var(--ok)' },
  { tag: [tags.number, tags.bool, tags.atom], color: 'var(--c2)' },
  { tag: tags.bracket, color: 'var(--ink)' },
]);

const look = EditorView.theme({
  '&': { fontSize: '13px', height: '100%', color: 'var(--ink)', backgroundColor: 'var(--paper)' },
  '.cm-scroller': { fontFamily: 'ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace', lineHeight: '1.5' },
  '.cm-content': { caretColor: 'var(--ink)' },
  '.cm-gutters': { backgroundColor: 'var(--faint)', color: 'var(--soft)', borderRight: '1px solid var(--line)' },
  '.cm-activeLine': { backgroundColor: 'color-mix(in srgb, var(--note-back) 55%, transparent)' },
  '.cm-activeLineGutter': { backgroundColor: 'var(--note-back)' },
  '.cm-cursor': { borderLeftColor: 'var(--ink)' },
  '&.cm-focused .cm-selectionBackground, .cm-selectionBackground': { backgroundColor: 'color-mix(in srgb, var(--link) 28%, transparent) !important' },
  '&.cm-focused': { outline: 'none' },
  '.cm-tooltip': { backgroundColor: 'var(--paper)', color: 'var(--ink)', border: '1px solid var(--rule)' },
  '.cm-tooltip-autocomplete ul li[aria-selected]': { backgroundColor: 'var(--link)', color: 'var(--paper)' },
  '.cm-diagnostic-error': { borderLeftColor: 'var(--failed)' },
  '.cm-lintRange-error': { backgroundImage: 'none', textDecoration: 'underline wavy var(--failed)' },
});

/** holder, changed(text), complete(context): CodeMirror's source of completions -> {text(), show(text), mark(mistakes), focus(line)}. */
export function makeEditor(holder, changed, complete) {
  let quiet = false;
  const view = new EditorView({
    parent: holder,
    extensions: [basicSetup, StreamLanguage.define(toml), syntaxHighlighting(colours), look, lintGutter(),
      autocompletion({ override: [complete] }),
      EditorView.contentAttributes.of({ 'aria-label': 'system or run, as TOML' }),
      EditorView.updateListener.of((update) => { if (update.docChanged && !quiet) changed(view.state.doc.toString()); })],
  });
  const lineOf = (number) => view.state.doc.line(Math.max(1, Math.min(number, view.state.doc.lines)));
  return {
    text: () => view.state.doc.toString(),
    show: (text) => {
      if (text === view.state.doc.toString()) return;
      quiet = true;
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text }, scrollIntoView: false });
      quiet = false;
    },
    /** [{line, column, text}]: each underlines from its column to the end of its line. */
    mark: (mistakes) => view.dispatch(setDiagnostics(view.state, mistakes.filter(({ line }) => line).map(({ line, column, text }) => {
      const { from, to } = lineOf(line);
      const start = Math.min(from + Math.max(0, (column ?? 1) - 1), to);
      return { from: start < to ? start : from, to, severity: 'error', message: text };
    }))),
    focus: (line) => {
      view.dispatch({ selection: { anchor: lineOf(line).from }, scrollIntoView: true });
      view.focus();
    },
  };
}
