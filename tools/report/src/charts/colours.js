// The colour scale of heat maps: viridis (van der Walt and Smith 2015) turned round, so that ink grows with the
// value. Its lightness is monotone: it reads in grey and with colour-blind eyes.

export const COLOURS = ['fde725', 'bbdf27', '7ad151', '43bf71', '22a884', '21908c', '2a788e', '35608d', '414487', '482576', '440154'].map((hex) => `#${hex}`);
const STOPS = COLOURS.map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));

/** t from 0 to 1 -> [r, g, b] from 0 to 255. */
export function sequential(t) {
  const place = Math.max(0, Math.min(1, t)) * (STOPS.length - 1);
  const i = Math.min(Math.floor(place), STOPS.length - 2);
  return STOPS[i].map((from, c) => Math.round(from + (STOPS[i + 1][c] - from) * (place - i)));
}

/** Relative luminance (WCAG 2) of [r, g, b]. */
export function luminance(rgb) {
  const linear = rgb.map((v) => (v <= 10 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}

/** The ink, dark or white, with the larger contrast on [r, g, b]. */
export const inkOn = (rgb) => (luminance(rgb) > 0.19 ? '#1d2329' : '#fff');
