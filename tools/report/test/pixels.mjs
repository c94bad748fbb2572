// Pictures as pixels: PNGs are decoded by a page of the browser.

/** Runs in a page: of each picture (or box of the one picture) the pixels that are not white and those neither white nor grey. */
async function count({ pngs, boxes }) {
  const read = async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return { context, width: image.width, height: image.height };
  };
  const survey = ({ data }) => {
    let [inked, colours] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [least, most] = [Math.min(data[i], data[i + 1], data[i + 2]), Math.max(data[i], data[i + 1], data[i + 2])];
      if (least < 250) ++inked;
      if (most - least > 40) ++colours;
    }
    return { inked, colours };
  };
  if (!boxes) return Promise.all(pngs.map(async (png) => (({ context, width, height }) => survey(context.getImageData(0, 0, width, height)))(await read(png))));
  const { context } = await read(pngs[0]);
  return boxes.map(({ x, y, width, height }) => survey(context.getImageData(x, y, width, height)));
}

/** Runs in a page: how many values clearly differ between two pictures of one size. */
async function differ(pngs) {
  const [a, b] = await Promise.all(pngs.map(async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height).data;
  }));
  return a.reduce((sum, v, i) => sum + (Math.abs(v - b[i]) > 60), 0);
}

const base64 = (png) => png.toString('base64');

/** PNGs -> [{inked, colours}]; with `boxes` {x, y, width, height}: of the parts of the first. */
export const countPixels = (page, pngs, boxes) => page.evaluate(count, { pngs: pngs.map(base64), boxes });
export const differences = (page, a, b) => page.evaluate(differ, [base64(a), base64(b)]);
