// Questions to the service, one at a time for each purpose: a newer question cancels the older one.

import { keyFromReader, storedKey } from "./key.js";

/** A refusal of the service: a problem document (RFC 9457). */
export class Refusal extends Error {
  constructor(problem) {
    super(problem.detail || problem.title || "refused");
    this.problem = problem;
    this.errors = problem.errors || [{ pointer: "", detail: this.message }];
  }
}

/** Fetch with the reader's key; while there is none, or a wrong one, wait for it, and while the service starts, for that. */
export async function fetched(path, options = {}) {
  for (;;) {
    const key = storedKey();
    const headers = key ? { ...options.headers, authorization: `Bearer ${key}` } : options.headers;
    const response = await fetch(path, { ...options, headers });
    if (response.status === 401) {
      await keyFromReader(key);
      continue;
    }
    if (response.status !== 503 || (await fetch("/readyz")).ok) return response;
    await new Promise((later) => setTimeout(later, 1000));
  }
}

export async function get(path, signal) {
  return content(await fetched(path, { signal }));
}

/** Send a question; returns the answer, the bytes it had and the time that the service took (ms). */
export async function ask(path, question, signal) {
  const body = typeof question === "string" ? question : JSON.stringify(question);
  const response = await fetched(path, { method: "POST", headers: { "content-type": "application/json" }, body, signal });
  const answer = await content(response);
  const timing = /dur=([\d.]+)/.exec(response.headers.get("server-timing") || "");
  return { answer, milliseconds: timing ? Number(timing[1]) : null };
}

async function content(response) {
  const text = await response.text();
  let document;
  try {
    document = JSON.parse(text);
  } catch {
    throw new Refusal({ detail: `the service answered ${response.status} without JSON` });
  }
  if (!response.ok) throw new Refusal(document);
  return document;
}

/** Runs one piece of work at a time and shows in `panel` when it takes longer than a second; it can be cancelled there. */
export class Worker {
  constructor(panel) {
    this.panel = panel;
    this.running = null;
    this.text = panel.querySelector("span");
    panel.querySelector("button").addEventListener("click", () => this.stop());
  }

  /** Give up what is under way. */
  stop() {
    this.running?.abort(new DOMException("cancelled", "AbortError"));
  }

  /** Run `work(send)`, which sends questions as `ask` does; returns null if newer work or the reader cancelled it. */
  async run(work) {
    this.running?.abort(new DOMException("replaced", "AbortError"));
    const mine = (this.running = new AbortController());
    let since = performance.now();
    const send = (path, question) => {
      since = performance.now();
      return ask(path, question, mine.signal);
    };
    const timer = setInterval(() => {
      const seconds = (performance.now() - since) / 1000;
      if (seconds < 1 || this.running !== mine) return;
      this.panel.hidden = false;
      this.text.textContent = `The service is computing: ${seconds.toFixed(0)} s`;
    }, 250);
    try {
      return await work(send);
    } catch (error) {
      if (mine.signal.aborted) return null;
      throw error;
    } finally {
      clearInterval(timer);
      if (this.running === mine) {
        this.panel.hidden = true;
        this.running = null;
      }
    }
  }
}
