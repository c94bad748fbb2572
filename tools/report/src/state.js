// What a page's verdicts say together.

const plural = (count, noun) => `${count} ${noun}${count === 1 ? '' : 's'}`;

/** The sections -> {text, failed: numbers of the blocks}, or null. Where no verdict is ok or failed, only records that
 * failed are told: a run that came to its end may still be wrong. */
export function stateOf(sections) {
  const blocks = sections.flatMap((section) => section?.blocks ?? []).map((block, i) => ({ block, number: i + 1 }));
  const verdicts = blocks.filter(({ block }) => block?.kind === 'verdict');
  const of = (status) => verdicts.filter(({ block }) => block.status === status);
  const [ok, notes] = [of('ok'), of('note')];
  const records = blocks.filter(({ block }) => block?.kind === 'record' && block.record?.status);
  const judged = ok.length + of('failed').length;
  const failed = (judged ? of('failed') : records.filter(({ block }) => block.record.status !== 'ok')).map(({ number }) => number);
  if (failed.length) return { text: `✕ ${failed.length} of ${judged || records.length} failed`, failed };
  if (!judged) return null;
  if (verdicts.length === 1) return { text: '✓ OK', failed };
  if (notes.length === 0) return { text: `✓ all ${ok.length} verdicts OK`, failed };
  return { text: `✓ ${plural(ok.length, 'verdict')} OK, ${plural(notes.length, 'note')}`, failed };
}
