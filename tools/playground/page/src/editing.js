// The editor and what it completes: a part of its own, which is loaded behind the first motion.

export { completions } from './complete.js';
export { makeEditor } from './editor.js';
