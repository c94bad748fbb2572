// In a worker, behind hamel.js: the functions of the module by their names.
//
// {compiled: WebAssembly.Module} once; then {id, name, request} -> {id, answer, numbers}.

let library = null;

const call = (name, request) => JSON.parse(library.ccall(`hamel_${name}`, 'string', request === undefined ? [] : ['string'],
  request === undefined ? [] : [JSON.stringify(request)]));

function numbers(name, count) {
  const at = library.ccall(`hamel_${name}`, 'number', [], []) / 8;
  return library.HEAPF64.slice(at, at + count);
}

/** What goes with an answer as an array of numbers. */
function numbersOf(name, answer) {
  if (!answer.ok) return null;
  if (name === 'run') return numbers('motion', library.ccall('hamel_motion_size', 'number', [], []));
  if (name === 'advance') return numbers('poses', answer.poses);
  return null;
}

onmessage = async ({ data }) => {
  if (data.compiled) {
    try {
      library = await createHamel({ instantiateWasm: (imports, done) => {
        WebAssembly.instantiate(data.compiled, imports).then((instance) => done(instance, data.compiled));
        return {};
      } });
      postMessage({ ready: true });
    } catch (error) {
      postMessage({ failed: `the library could not be loaded: ${error}` });
    }
    return;
  }
  const { id, name, request } = data;
  let answer;
  let beside = null;
  try {
    answer = call(name, request);
    beside = numbersOf(name, answer);
  } catch (error) {  // a trap: the memory of the library is no longer to be relied on
    answer = { ok: false, broken: true, mistakes: [`the library ended: ${error.message ?? error}`] };
  }
  postMessage({ id, answer, numbers: beside }, beside ? [beside.buffer] : []);
};
