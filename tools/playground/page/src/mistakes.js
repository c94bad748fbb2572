// Messages of the library -> where they belong: "cart.toml:12:5: what" of the file of the text.

export function mistakesOf(messages, file) {
  return messages.map((message) => {
    const at = message.startsWith(`${file}:`) ? /^:(\d+)(?::(\d+))?:\s*([^]*)$/.exec(message.slice(file.length)) : null;
    return at ? { line: Number(at[1]), column: at[2] ? Number(at[2]) : null, text: at[3] } : { line: null, column: null, text: message };
  });
}
