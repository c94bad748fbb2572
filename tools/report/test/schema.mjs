// The data of a page against schema.json.

import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import Ajv from 'ajv';

const here = dirname(fileURLToPath(import.meta.url));
const ajv = new Ajv({ strictTypes: false });
const validate = ajv.compile(JSON.parse(readFileSync(join(here, '../schema.json'), 'utf8')));

/** The text of a page -> '' where its data fit the schema, else what does not. */
export function misfit(html) {
  const text = html.match(/id="hamel-data">([\s\S]*?)<\/script>/)?.[1];
  let data;
  try {
    data = JSON.parse(text);
  } catch {
    return '';  // unreadable data are the page's own complaint
  }
  if (validate(data)) return '';
  const { instancePath, message, params } = validate.errors[0];
  return `${instancePath} ${message} ${JSON.stringify(params)}`;
}
