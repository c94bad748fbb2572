// Puts data into the built page the way the C++ program does.

export function fill(page, text) {
  return page.replace('__HAMEL_DATA__', () => text.replaceAll('</', '<\\/'));
}
