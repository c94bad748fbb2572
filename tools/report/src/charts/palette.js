// One look per series name on the whole page: ten colours of the style sheet that stay apart for colour-blind eyes
// (after Okabe and Ito, and Tol). Beyond ten names a colour serves again where the two never meet in a figure (or, if
// need be, are kept apart by its filters); then come dashes. Series with a `key` share the look of that key.

/** Modes of a contact, beside a motion and over the time. */
export const MODES = ['open', 'rolls', 'slides'];
const OF_MODES = { open: '--mesh', rolls: '--c3', slides: '--c2' };
/** The variable of the style sheet with the colour of a mode; undefined of other names. */
export const colourOfMode = (name) => (Object.hasOwn(OF_MODES, name) ? OF_MODES[name] : undefined);

const COLOURS = Array.from({ length: 10 }, (_, i) => `var(--c${i + 1})`);
const DASHES = [[], [8, 3], [2, 3], [9, 3, 2, 3]];
const DASHED = [7, 4];

let styles = new Map();

const nameOf = (series) => String(series?.key ?? series?.name);

/** What of a block has a look: its series, or its classes. */
const seriesOf = (block) => (Array.isArray(block?.series) ? block.series : block?.kind === 'scatter' && !block.classes ? [{ name: 'members' }] :
  Array.isArray(block?.classes) && !block.classes.every(colourOfMode) ? block.classes.map((name) => ({ name })) : null);

/** The names of a block that are seen at one time: all, or those whose tags a filter shows together. */
function seenTogether(block) {
  if (!Array.isArray(block.filters)) return [block.series.map(nameOf)];
  const tags = (s) => JSON.stringify(block.filters.map((filter) => s?.tags?.[filter?.name]));
  return [...new Set(block.series.map(tags))].map((group) => block.series.filter((s) => tags(s) === group).map(nameOf));
}

/** Gives every name of the page its style. */
export function assignStyles(sections) {
  styles = new Map();
  const blocks = sections.flatMap((section) => section?.blocks ?? []).flatMap((block) => (seriesOf(block) ? [{ filters: block.filters, series: seriesOf(block) }] : []));
  const figures = blocks.flatMap(seenTogether);
  const inBlock = blocks.map((block) => block.series.map(nameOf));
  const all = DASHES.flatMap((dash) => COLOURS.map((colour) => ({ colour, dash, names: 0 })));
  for (const name of figures.flat()) {
    if (styles.has(name)) continue;
    const stylesNear = (lists) => new Set(lists.filter((names) => names.includes(name)).flat().map((other) => styles.get(other)));
    const [met, near] = [stylesNear(figures), stylesNear(inBlock)];
    const free = all.filter((style) => !met.has(style));
    const solid = free.filter((style) => style.dash.length === 0).sort((a, b) => near.has(a) - near.has(b) || a.names - b.names);
    const style = solid[0] ?? free[0] ?? all[styles.size % all.length];
    ++style.names;
    styles.set(name, style);
  }
}

/** -> {colour, dash} of a series; the data's `dashed` wins over the palette's own dash. */
export function styleOf(series) {
  const style = styles.get(nameOf(series)) ?? { colour: COLOURS[0], dash: [] };
  return series.dashed ? { colour: style.colour, dash: DASHED } : style;
}
