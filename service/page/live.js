// Questions as a scene changes: one at a time, the newest next, so that the picture follows as fast as answers come.

const PATIENCE = 400;
/** Milliseconds after which a question that is still under way gives way to a newer one. */

export class Live {
  /** `work(question)` asks and shows; `stop()` gives up what it waits for. */
  constructor(work, stop) {
    this.work = work;
    this.stop = stop;
    /** @type {Promise<void> | null} */
    this.running = null;
    /** @type {string | null} */
    this.next = null;
    this.since = 0;
  }

  /** Ask this, unless something newer comes first; resolves when nothing is left to ask. */
  ask(question) {
    this.next = question;
    if (!this.running) this.running = this.run().finally(() => { this.running = null; });
    else if (performance.now() - this.since > PATIENCE) this.stop();
    return this.running;
  }

  async run() {
    while (this.next !== null) {
      const question = this.next;
      this.next = null;
      this.since = performance.now();
      await this.work(question);
    }
  }
}
