// The library in its worker: calls as promises, and a worker in place of one that is lost or takes too long.

/** {worker() -> Worker, compiled: Promise of a WebAssembly.Module, stored(name) -> a motion or null}: how the page has them, in files or within itself. */
export class Library {
  constructor(source) {
    this.source = source;
    this.compiled = source.compiled;
    this.compiled.catch(() => {});  // told by whoever calls
    this.waiting = new Map();
    this.count = 0;
    this.#start();
  }

  #start() {
    this.worker = this.source.worker();
    const { worker } = this;
    this.ready = new Promise((resolve, reject) => {
      worker.onerror = (event) => reject(new Error(event.message || 'the worker could not be started'));
      worker.onmessage = ({ data }) => {
        if (data.ready) return resolve();
        if (data.failed) return reject(new Error(data.failed));
        this.waiting.get(data.id)?.(data);
        this.waiting.delete(data.id);
        if (data.answer.broken) this.restart();
      };
    });
    this.ready.catch(() => {});  // told by whoever calls
    this.compiled.then((compiled) => worker.postMessage({ compiled }), (error) => worker.onerror(error));
  }

  /** -> {answer, numbers}. A call that `restart` ends has the answer {ok: false, ended: true}. */
  async call(name, request) {
    await this.ready;
    const id = ++this.count;
    const back = new Promise((resolve) => { this.waiting.set(id, resolve); });
    this.worker.postMessage({ id, name, request });
    return back;
  }

  /** Ends what runs. */
  restart() {
    this.worker.terminate();
    this.waiting.forEach((resolve) => resolve({ answer: { ok: false, ended: true, mistakes: [] }, numbers: null }));
    this.waiting.clear();
    this.#start();
  }
}
