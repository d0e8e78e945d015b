import { addressOf, pause, reporting, secondsOf } from "./exchange.js";
import type { Asked, Options } from "./exchange.js";
import { Operations } from "./operations.js";
import { Refused } from "./refused.js";
import type { components } from "./schema.js";

/** What a client is made with, besides the address of the service. */
export interface Settings extends Omit<Options, "signal"> {
  /** Sent as `Authorization: Bearer`. */
  readonly key?: string;
  /** In place of the platform's own. */
  readonly fetch?: typeof fetch;
}

export type StudyState = components["schemas"]["StudyState"];

const BUSY: readonly number[] = [429, 503];
const SECONDS = 60;

/** A client of a Polhode service; each operation is a method, which throws `Refused` for a problem. */
export class Polhode extends Operations {
  readonly #url: string;
  readonly #settings: Settings;

  constructor(url: string, settings: Settings = {}) {
    super();
    this.#url = url;
    this.#settings = settings;
  }

  protected async ask<Answer>(asked: Asked, options: Options): Promise<Answer> {
    const { timeout = SECONDS, patience = SECONDS, progress, signal } = { ...this.#settings, ...options };
    const headers: Record<string, string> = { accept: `${asked.media}, application/problem+json;q=0.1` };
    if (this.#settings.key !== undefined) headers["authorization"] = `Bearer ${this.#settings.key}`;
    if (asked.question !== undefined) headers["content-type"] = "application/json";
    if (asked.once === true) headers["idempotency-key"] = crypto.randomUUID();
    const body = asked.question === undefined ? null : JSON.stringify(asked.question);
    for (let left = patience; ; ) {
      const limits = [AbortSignal.timeout(1000 * timeout), ...(signal === undefined ? [] : [signal])];
      const ended = reporting(progress, asked.path);
      let wait: number | undefined;
      try {
        const send = this.#settings.fetch ?? fetch;
        const request = { method: asked.method, headers, body, signal: AbortSignal.any(limits) };
        const response = await send(addressOf(this.#url, asked), request);
        if (response.ok) return (await read(response, asked.media)) as Answer;
        wait = secondsOf(response.headers.get("retry-after"));
        if (!BUSY.includes(response.status) || wait === undefined || wait > left)
          throw await Refused.read(response, wait);
        await response.body?.cancel();
      } finally {
        ended();
      }
      // A service that says to wait for no time at all is not asked for ever.
      left -= Math.max(wait, 0.01);
      await pause(wait, signal);
    }
  }

  /** Waits until a study has ended, and returns its state; `progress` gets every state, also the last. */
  async finished(
    study: string,
    { every = 0.5, signal, progress }: { every?: number; signal?: AbortSignal; progress?: (state: StudyState) => void } = {},
  ): Promise<StudyState> {
    for (;;) {
      const state = await this.get_study(study, signal === undefined ? {} : { signal });
      progress?.(state);
      if (state.status !== "accepted" && state.status !== "running") return state;
      await pause(every, signal);
    }
  }
}

async function read(response: Response, media: string): Promise<unknown> {
  if (media === "application/json") return response.json();
  if (/^(text\/|image\/svg)/.test(media)) return response.text();
  return new Uint8Array(await response.arrayBuffer());
}
